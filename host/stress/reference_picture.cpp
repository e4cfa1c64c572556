// SPDX-License-Identifier: Apache-2.0
#include "host/stress/reference_picture.h"

#include <algorithm>
#include <cmath>

#include "host/base/parallel.h"

namespace rt {

namespace {

constexpr double nearby = 0.02;  // pixels
constexpr double least_change = 0.5 / 255;
constexpr std::size_t pixel_run = 16;

/// The eight moves of a sample: along the axes and the diagonals.
constexpr double diagonal = 0.70710678 * nearby;
constexpr std::array<std::array<double, 2>, 8> moves{{{nearby, 0},
                                                      {-nearby, 0},
                                                      {0, nearby},
                                                      {0, -nearby},
                                                      {diagonal, diagonal},
                                                      {-diagonal, diagonal},
                                                      {diagonal, -diagonal},
                                                      {-diagonal, -diagonal}}};

bool differ(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double change = std::clamp(a[c], 0.0, 1.0) - std::clamp(b[c], 0.0, 1.0);
        if (!(std::fabs(change) <= least_change)) return true;
    }
    return false;
}

}  // namespace

ReferencePicture::ReferencePicture(const Scene& scene, ReferenceKind kind)
    : width_(scene.width),
      height_(scene.height),
      grid_(scene.aa.count),
      tracer_(make_reference_tracer(scene, kind)),
      colors_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      edges_(colors_.size(), -1) {
    for_each_run(colors_.size(), pixel_run, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i) colors_[i] = pixel_color(i, 0, 0);
                 });
}

std::array<double, 3> ReferencePicture::pixel_color(std::size_t pixel, double dx, double dy) const {
    const auto width = static_cast<std::size_t>(width_);
    std::array<double, 3> sum{};
    for (int i = 0; i < grid_ * grid_; ++i) {
        const double x = static_cast<double>(pixel % width) + (i % grid_ + 0.5) / grid_;
        const double y = static_cast<double>(pixel / width) + (i / grid_ + 0.5) / grid_;
        const std::array<double, 3> color = tracer_->color_at(x, y, dx, dy);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += color[c] / (grid_ * grid_);
    }
    return sum;
}

bool ReferencePicture::changes_nearby(std::size_t pixel) const {
    return std::any_of(moves.begin(), moves.end(), [&](const std::array<double, 2>& move) {
        return differ(colors_[pixel], pixel_color(pixel, move[0], move[1]));
    });
}

std::vector<bool> ReferencePicture::at_edges(std::span<const std::size_t> pixels) {
    for_each_run(pixels.size(), pixel_run, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i) {
                         std::int8_t& edge = edges_[pixels[i]];
                         if (edge < 0) edge = changes_nearby(pixels[i]) ? 1 : 0;
                     }
                 });
    std::vector<bool> answer;
    for (const std::size_t pixel : pixels) answer.push_back(edges_[pixel] == 1);
    return answer;
}

Picture ReferencePicture::as_picture() const {
    Picture picture{width_, height_, 3, {}};
    for (const auto& color : colors_) {
        for (const double value : color) picture.pixels.push_back(static_cast<float>(value));
    }
    return picture;
}

}  // namespace rt
