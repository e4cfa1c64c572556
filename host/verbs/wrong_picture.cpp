// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/wrong_picture.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <optional>

#include "host/base/error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/process/stop_signal.h"
#include "host/verbs/render_steps.h"

namespace rt {

namespace {

/// Its index; bits are compared.
std::optional<std::size_t> first_difference(const Picture& a, const Picture& b) {
    for (std::size_t at = 0; at < a.pixels.size(); at += 3) {
        if (std::memcmp(&a.pixels[at], &b.pixels[at], 3 * sizeof(float)) != 0) return at / 3;
    }
    return std::nullopt;
}

std::string save(const Picture& picture, const RenderOptions& options, const char* kind) {
    std::filesystem::path path = options.output;
    path.replace_extension(kind + path.extension().string());
    if (std::filesystem::exists(path)) throw Error(ExitCode::output, path.string() + " exists");
    write_picture(path.string(), picture, options.encoding);
    return path.string();
}

}  // namespace

std::string keep_wrong_picture(const Scene& scene, const RenderOptions& options) try {
    RenderSettings settings = options;
    settings.self_test = false;
    settings.check = 0;
    settings.journal.clear();
    const auto render = [&](const std::vector<DeviceChoice>& devices) {
        return render_picture(scene, settings, devices, {}, stop_flag());
    };
    const RenderedPicture wrong = render(start_finding_devices(options).get());
    const RenderedPicture right = render({threads_choice()});
    const auto first = first_difference(wrong.picture, right.picture);
    if (!first) return "; rendered again, it is the picture of threads";
    const Rect& region = wrong.stats.region;
    const auto width = static_cast<std::size_t>(region.width);
    const std::string text = fmt::format("; the first wrong pixel is {},{}",
                                         static_cast<std::size_t>(region.x) + *first % width,
                                         static_cast<std::size_t>(region.y) + *first / width);
    if (options.output.empty() || options.output == stdout_path || options.shares) return text;
    const std::string kept = save(wrong.picture, options, ".wrong");
    return text + "; compare " + kept + " with " + save(right.picture, options, ".right");
} catch (const Error& error) {
    return std::string("; cannot keep its picture: ") + error.what();
}

}  // namespace rt
