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

/// The points of one device at the precision and math of `picture`, in the order of the sweep.
void add_points(const ConvergeOptions& options, const std::vector<int>& bounces,
                const SweptDevice& device, PictureSpec picture,
                std::vector<ConvergePoint>& points) {
    for (const int max_bounces : bounces) {
        for (const AaMode& aa : options.aa) {
            picture.max_bounces = max_bounces;
            picture.aa = aa;
            points.emplace_back().asked = {device.spec(), device.choice.name(), picture};
        }
    }
}

/// Omits double on devices without it and on scalar threads, which only show what vectors gain, and
/// fast math on threads: it is an OpenCL compiler option.
std::vector<ConvergePoint> planned_points(const ConvergeOptions& options, const Scene& scene,
                                          const std::vector<int>& bounces,
                                          const std::vector<SweptDevice>& devices) {
    std::vector<ConvergePoint> points;
    for (const SweptDevice& device : devices) {
        for (const Precision precision : options.precisions) {
            if (precision == Precision::float64 &&
                (!device.choice.has_double() || device.is_scalar))
                continue;
            for (const Math math : options.math) {
                if (math == Math::fast && device.choice.use_threads) continue;
                PictureSpec picture = picture_spec(scene, {});
                picture.precision = precision;
                picture.math = math;
                add_points(options, bounces, device, picture, points);
            }
        }
    }
    return points;
}

TimedCase timed_case(const ConvergeCase& asked, const ConvergeOptions& options,
                     const std::vector<SweptDevice>& devices) {
    TimedCase timed;
    timed.path = options.scene;
    const SweptDevice& device = *std::ranges::find(devices, asked.device, &SweptDevice::spec);
    timed.device = device.choice;
    timed.settings = timed_settings(settings_for(asked.picture));
    if (device.is_scalar) timed.settings.kernels.lanes = 1;
    if (device.choice.use_threads && device.choice.threads == 0)
        timed.settings.threads = options.threads;
    return timed;
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
void time_points(const Scene& scene, double load_seconds, const ConvergedPicture& converged,
                 const ConvergeOptions& options, const std::vector<SweptDevice>& devices,
                 ConvergeResult& result) {
    std::vector<TimedCase> cases;
    using Key = std::tuple<Precision, int, std::string>;
    std::map<Key, std::optional<RenderStats>> pictures;  ///< every device must give these bits
    for (ConvergePoint& point : result.points) {
        TimedCase timed = timed_case(point.asked, options, devices);
        timed.scene = &scene;
        timed.reference = &converged.picture;
        timed.load_seconds = load_seconds;
        if (point.asked.picture.math == Math::strict) {
            const PictureSpec& asked = point.asked.picture;
            const auto [place, is_new] =
                pictures.try_emplace({asked.precision, asked.max_bounces, to_string(asked.aa)});
            if (is_new) place->second = picture_of_threads(scene, timed.settings);
            if (const auto& picture = place->second) {
                timed.expected_hash = picture->image_hash;
                point.estimate = picture->estimate;
            }
        }
        cases.push_back(std::move(timed));
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
    const Stopwatch watch;
    Scene scene = load_scene(options.scene, options.light);
    const double load_seconds = watch.seconds();
    say_busy(options.quiet);
    if (options.size) set_image_size(scene, options.size->width, options.size->height);
    result.scene = {options.scene, scene.name, scene_hash(scene)};
    result.notes = scene.notes;
    result.width = scene.width;
    result.height = scene.height;
    std::vector<int> bounces = options.max_bounces;
    if (bounces.empty()) bounces.push_back(scene.max_bounces);
    const std::vector<SweptDevice> devices = swept_devices(options);
    result.points = planned_points(options, scene, bounces, devices);
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
    if (converged.complete) {
        time_points(scene, load_seconds, converged, options, devices, result);
    }
    result.summarize();
    result.load_before = other_load();
    return result;
}

}  // namespace rt
