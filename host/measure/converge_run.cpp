// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/image/image_error.h"
#include "host/image/picture_io.h"
#include "host/measure/converge.h"
#include "host/measure/machine_load.h"
#include "host/measure/timing.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

struct ConvergedPicture {
    Picture picture;
    ConvergeReference about;
    bool complete = true;  ///< false when a signal stopped it
};

std::uint64_t hash_of(const Picture& picture) {
    Hasher hasher;
    hasher.add_bytes(std::as_bytes(std::span(picture.pixels)));
    return hasher.value();
}

void check_reference(const Picture& picture, const std::string& name) {
    if (const std::size_t count = count_non_finite(picture); count > 0) {
        throw Error(ExitCode::non_finite,
                    fmt::format("{}: {} not finite; look for very large numbers in the scene", name,
                                counted(count, "pixel is", "pixels are")));
    }
}

/// --reference: a picture rendered before.
ConvergedPicture kept_picture(const Scene& scene, const std::string& path) {
    ConvergedPicture kept;
    kept.picture = read_picture(path);
    check_reference(kept.picture, path);
    if (kept.picture.width != scene.width || kept.picture.height != scene.height ||
        kept.picture.channels != 3) {
        throw Error(ExitCode::input,
                    fmt::format("{}: not {}x{} pixels of 3 channels; render it at the same --size",
                                path, scene.width, scene.height));
    }
    kept.about.file = path;
    kept.about.hash_a = hash_of(kept.picture);
    return kept;
}

/// A half is sampled with a seed that no timed picture has.
RenderedPicture render_half(Scene scene, int seed, const ConvergeOptions& options) {
    scene.aa = *parse_aa_mode(fmt::format("sobol:{}", options.reference_samples));
    scene.sampling_seed = seed;
    if (!options.quiet) {
        print_note(fmt::format("rendering half {} of the reference, {} in double", seed,
                               to_string(scene.aa)));
    }
    RenderSettings settings = timed_settings();
    settings.precision = Precision::float64;
    return render_quietly(scene, settings, threads_choice());
}

Picture mean_of(const Picture& a, const Picture& b) {
    Picture mean = a;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        mean.pixels[i] = static_cast<float>((double{a.pixels[i]} + double{b.pixels[i]}) / 2);
    }
    return mean;
}

/// The converged picture of a scene at its own size and bounces: the mean of two halves, rendered
/// in double on threads, and kept in the file of --reference, or read from it.
ConvergedPicture converged_picture(const Scene& scene, const ConvergeOptions& options) {
    const Stopwatch watch;
    std::error_code ignored;
    if (std::filesystem::exists(options.reference, ignored)) {
        return kept_picture(scene, options.reference);
    }
    const RenderedPicture a = render_half(scene, 1, options);
    ConvergedPicture converged;
    converged.complete = a.stats.complete();
    if (!converged.complete) return converged;
    const RenderedPicture b = render_half(scene, 2, options);
    converged.complete = b.stats.complete();
    if (!converged.complete) return converged;
    check_reference(a.picture, "the reference");
    check_reference(b.picture, "the reference");
    ConvergeReference& about = converged.about;
    about.aa_a = fmt::format("sobol:{} seed 1", options.reference_samples);
    about.aa_b = fmt::format("sobol:{} seed 2", options.reference_samples);
    about.max_bounces = scene.max_bounces;
    about.hash_a = hash_of(a.picture);
    about.hash_b = hash_of(b.picture);
    about.halves_rmse = image_error(clamped(a.picture), clamped(b.picture)).rmse;
    converged.picture = mean_of(a.picture, b.picture);
    if (!options.reference.empty()) {
        write_picture(options.reference, converged.picture, Encoding::display);
    }
    about.seconds = watch.seconds();
    return converged;
}

struct SweptDevice {
    DeviceChoice choice;
    bool is_scalar = false;  ///< threads that trace one ray at a time

    std::string spec() const { return choice.spec() + (is_scalar ? " scalar" : ""); }
};

/// The devices named, plus scalar threads if requested.
std::vector<SweptDevice> swept_devices(const ConvergeOptions& options) {
    std::vector<SweptDevice> devices;
    for (const DeviceChoice& choice : listed_devices(options.devices)) {
        devices.push_back({choice});
        if (options.scalar && choice.use_threads) devices.push_back({choice, true});
    }
    return devices;
}

/// The pictures of one device's sweep, in its order. Omits double on devices without it and on
/// scalar threads, which only show what vectors gain, and fast math on threads: it is an OpenCL
/// compiler option.
std::vector<PictureSpec> swept_pictures(const ConvergeOptions& options, const Scene& scene,
                                        const std::vector<int>& bounces,
                                        const SweptDevice& device) {
    const bool can_do_double = device.choice.has_double() && !device.is_scalar;
    std::vector<PictureSpec> pictures;
    PictureSpec picture = picture_spec(scene, {});
    for (const Precision precision : options.precisions) {
        if (precision == Precision::float64 && !can_do_double) continue;
        for (const Math math : options.math) {
            if (math == Math::fast && device.choice.use_threads) continue;
            picture.precision = precision;
            picture.math = math;
            for (const int max_bounces : bounces) {
                for (const AaMode& aa : options.aa) {
                    picture.max_bounces = max_bounces;
                    picture.aa = aa;
                    pictures.push_back(picture);
                }
            }
        }
    }
    return pictures;
}

/// What it takes to time each of the points, which are added to the result.
std::vector<TimedCase> plan(const ConvergeOptions& options, const TimedScene& scene,
                            const std::vector<int>& bounces, ConvergeResult& result) {
    std::vector<TimedCase> cases;
    for (const SweptDevice& device : swept_devices(options)) {
        const DeviceChoice& choice = device.choice;
        for (const PictureSpec& picture : swept_pictures(options, scene.scene, bounces, device)) {
            result.points.emplace_back().asked = {device.spec(), choice.name(), picture};
            TimedCase& timed = cases.emplace_back();
            timed.scene = &scene;
            timed.device = choice;
            timed.settings = timed_settings(settings_for(picture));
            if (device.is_scalar) timed.settings.kernels.lanes = 1;
            if (choice.use_threads && choice.threads == 0) {
                timed.settings.threads = options.threads;
            }
        }
    }
    return cases;
}

/// A picture as threads compute it, with an estimate of its error; empty if the render was stopped.
std::optional<RenderStats> picture_of_threads(Scene scene, RenderSettings settings) {
    settings.kernels.lanes = 0;
    settings.estimate = true;
    apply_overrides(scene, settings);
    RenderStats stats = render_quietly(scene, settings, threads_choice()).stats;
    return stats.complete() ? std::optional(std::move(stats)) : std::nullopt;
}

/// Times the points of the result against the converged picture.
void time_points(const ConvergedPicture& converged, const ConvergeOptions& options,
                 std::vector<TimedCase> cases, ConvergeResult& result) {
    using Key = std::tuple<Precision, int, std::string>;
    std::map<Key, std::optional<RenderStats>> pictures;  ///< every device must give these bits
    for (std::size_t i = 0; i < cases.size(); ++i) {
        cases[i].reference = &converged.picture;
        const PictureSpec& asked = result.points[i].asked.picture;
        if (asked.math != Math::strict) continue;
        const auto [place, is_new] =
            pictures.try_emplace({asked.precision, asked.max_bounces, to_string(asked.aa)});
        if (is_new) place->second = picture_of_threads(cases[i].scene->scene, cases[i].settings);
        if (const auto& picture = place->second) {
            cases[i].expected_hash = picture->image_hash;
            result.points[i].estimate = picture->estimate;
        }
    }
    result.interrupted = !run_rounds(cases, options.repeats, options.quiet);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        static_cast<TimedRuns&>(result.points[i]) = std::move(cases[i]);
    }
}

}  // namespace

ConvergeResult measure_converge(const ConvergeOptions& options) {
    ConvergeResult result;
    result.repeats_asked = options.repeats;
    other_load();
    TimedScene loaded = load_timed_scene(options.scene, options.light, options.quiet);
    Scene& scene = loaded.scene;
    say_busy(options.quiet);
    if (options.size) set_image_size(scene, options.size->width, options.size->height);
    result.scene = loaded.id = {options.scene, scene.name, scene_hash(scene)};
    result.width = scene.width;
    result.height = scene.height;
    std::vector<int> bounces = options.max_bounces;
    if (bounces.empty()) bounces.push_back(scene.max_bounces);
    std::vector<TimedCase> cases = plan(options, loaded, bounces, result);
    if (result.points.empty()) {
        throw Error(
            ExitCode::usage,
            "nothing to measure: no device supports this combination of --precision and --math");
    }
    bounces.push_back(scene.max_bounces);
    scene.max_bounces = std::ranges::max(bounces);
    const ConvergedPicture converged = converged_picture(scene, options);
    result.reference = converged.about;
    result.interrupted = !converged.complete;
    if (converged.complete) time_points(converged, options, std::move(cases), result);
    result.summarize();
    result.load_before = other_load();
    return result;
}

}  // namespace rt
