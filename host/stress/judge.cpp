// SPDX-License-Identifier: Apache-2.0
#include "host/stress/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>

#include "host/base/parallel.h"
#include "host/base/text.h"

namespace rt {

namespace {

constexpr double wrong_error = 1.0 / 255;
constexpr double edge_matters = 2e-5;

}  // namespace

PictureFigures count_non_numbers(const Picture& picture) {
    PictureFigures figures;
    for (std::size_t i = 0; i + 2 < picture.pixels.size(); i += 3) {
        const auto pixel = std::span(picture.pixels).subspan(i, 3);
        figures.nans += std::ranges::any_of(pixel, [](float v) { return std::isnan(v); });
        figures.infinities += std::ranges::any_of(pixel, [](float v) { return std::isinf(v); });
    }
    return figures;
}

PictureFigures judge_stress_picture(const Picture& picture, ReferencePicture& reference) {
    PictureFigures figures = count_non_numbers(picture);
    std::mutex mutex;
    const auto judge = [&](std::size_t i) {
        const float* const pixel = &picture.pixels[3 * i];
        const double error = color_difference({pixel[0], pixel[1], pixel[2]}, reference.color(i));
        const bool at_edge = error > edge_matters && reference.is_at_edge(i);
        const std::scoped_lock lock(mutex);
        if (!at_edge) figures.max_error = std::max(figures.max_error, error);
        if (error > wrong_error) ++(at_edge ? figures.wrong_at_edges : figures.wrong);
    };
    for_each_run(picture.pixels.size() / 3, 16, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first; i < last; ++i) judge(i);
                 });
    return figures;
}

std::string exceeded_tolerance(const PictureFigures& figures, const StressTolerance& tolerance) {
    if (figures.nans > 0) return counted(figures.nans, "pixel is", "pixels are") + " NaN";
    if (figures.infinities > 0 && !tolerance.may_overflow) {
        return counted(figures.infinities, "pixel is", "pixels are") + " infinite";
    }
    if (figures.wrong > tolerance.most_wrong)
        return counted(figures.wrong, "pixel is", "pixels are") + " wrong";
    if (figures.wrong_at_edges > tolerance.most_wrong_at_edges) {
        return counted(figures.wrong_at_edges, "pixel is", "pixels are") + " wrong at edges";
    }
    if (!(figures.max_error <= tolerance.max_error)) {
        return fmt::format("off by {:.2g}", figures.max_error);
    }
    return "";
}

std::string exceeded_tolerance(const RayFigures& rays, const StressTolerance& tolerance) {
    if (rays.rays == 0) return "no ray was traced";
    if (rays.failures > tolerance.most_wrong) {
        return fmt::format("{} of {} rays fail", rays.failures, rays.rays);
    }
    if (!(rays.max_error <= tolerance.max_error)) {
        return fmt::format("off by {:.2g}", rays.max_error);
    }
    return "";
}

bool StressCaseResult::passed() const {
    return disagreement.empty() && !rows.empty() && std::ranges::all_of(rows, &StressRow::passed);
}

bool StressFamilyResult::passed() const {
    return !cases.empty() && std::ranges::all_of(cases, &StressCaseResult::passed);
}

bool StressResult::passed() const {
    return !families.empty() && !interrupted &&
           std::ranges::all_of(families, &StressFamilyResult::passed);
}

}  // namespace rt
