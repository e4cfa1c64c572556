// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/text.h"
#include "host/cli/render_pictures.h"
#include "host/explain/pixel_facts.h"
#include "host/image/false_color.h"
#include "host/image/output_file.h"
#include "host/image/picture_io.h"
#include "host/process/stop_signal.h"

namespace rt {

namespace {

bool is_exr(const RenderOptions& options) {
    return picture_format_of_name(options.output) == PictureFormat::exr;
}

std::string next_to(const std::string& output, const std::string& ending) {
    return std::filesystem::path(output).replace_extension(ending).string();
}

std::vector<std::string> aov_files(const RenderOptions& options) {
    if (is_exr(options)) return {next_to(options.output, ".aov.exr")};
    std::vector<std::string> files;
    for (const Aov aov : options.aovs) {
        files.push_back(next_to(options.output, std::string(".") + to_string(aov) + ".png"));
    }
    return files;
}

/// The requested AOVs, as numbers.
class Aovs {
   public:
    Aovs(const Scene& scene, const RenderStats& stats, const RenderOptions& options)
        : width_(stats.picture.region.width), height_(stats.picture.region.height) {
        const auto needs = [&](Aov aov) { return std::ranges::count(options.aovs, aov) > 0; };
        if (needs(Aov::depth) || needs(Aov::normal) || needs(Aov::id)) {
            hits_ = pixel_hits(scene, stats.picture.region, stop_flag());
        }
        if (!needs(Aov::rays) && !needs(Aov::samples)) return;
        work_ = stats.picture.precision == Precision::float64
                    ? pixel_work<double>(scene, stats.picture.region, stop_flag())
                    : pixel_work<float>(scene, stats.picture.region, stop_flag());
    }

    Picture in_false_colors(Aov aov) const {
        if (aov == Aov::normal) return color_normals(hits_.normal, width_, height_);
        if (aov == Aov::id) return color_ids(hits_.id, width_, height_);
        return color_numbers(plane(aov), width_, height_,
                             aov == Aov::depth ? Scale::linear : Scale::logarithmic);
    }

    /// What the colors of `in_false_colors` mean.
    std::string key(Aov aov) const {
        if (aov == Aov::normal) return "x, y, z from -1 to 1 as red, green, blue";
        if (aov == Aov::id) return "a color for each object";
        const auto [least, most] = range_of(plane(aov));
        return fmt::format("violet {:.4g} to yellow {:.4g}{}", least, most,
                           aov == Aov::depth ? "" : ", logarithmic");
    }

    /// The given AOVs as channels of one picture.
    Picture as_channels(const std::vector<Aov>& aovs) const {
        Picture picture;
        picture.width = width_;
        picture.height = height_;
        std::vector<std::vector<float>> planes;
        for (const Aov aov : aovs) {
            if (aov != Aov::normal) {
                picture.channel_names.emplace_back(to_string(aov));
                planes.push_back(plane(aov));
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                picture.channel_names.push_back(std::string("normal.") + "XYZ"[k]);
                std::vector<float>& part = planes.emplace_back();
                for (std::size_t i = k; i < hits_.normal.size(); i += 3) {
                    part.push_back(hits_.normal[i]);
                }
            }
        }
        picture.channels = static_cast<int>(planes.size());
        for (std::size_t i = 0; i < planes.front().size(); ++i) {
            for (const std::vector<float>& values : planes) picture.pixels.push_back(values[i]);
        }
        return picture;
    }

   private:
    std::vector<float> plane(Aov aov) const {
        if (aov == Aov::depth) return hits_.depth;
        if (aov == Aov::id) return {hits_.id.begin(), hits_.id.end()};
        if (aov == Aov::rays) return {work_.rays.begin(), work_.rays.end()};
        return {work_.samples.begin(), work_.samples.end()};
    }

    const int width_, height_;
    PixelHits hits_;
    PixelWork work_;
};

}  // namespace

void check_aov_files(const RenderOptions& options, UsedFiles used) {
    if (options.aovs.empty()) return;
    const std::vector<std::string> files = aov_files(options);
    for (const std::string& file : files) check_picture_path(file);
    used.add(options.output);
    check_outputs(files, std::move(used));
}

bool write_aovs(const Scene& scene, const RenderStats& stats, const RenderOptions& options) {
    if (options.aovs.empty() || !stats.complete()) return true;
    const Aovs aovs(scene, stats, options);
    if (stop_flag() != 0) {
        print_note("stopped; --aov saved nothing");
        return false;
    }
    const std::vector<std::string> files = aov_files(options);
    if (is_exr(options)) {
        write_picture(files.front(), aovs.as_channels(options.aovs), Encoding::linear);
    } else {
        for (std::size_t i = 0; i < files.size(); ++i) {
            write_picture(files[i], aovs.in_false_colors(options.aovs[i]), Encoding::display);
            if (!options.quiet) print_note(printable(files[i]) + ": " + aovs.key(options.aovs[i]));
        }
    }
    return true;
}

}  // namespace rt
