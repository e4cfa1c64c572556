// SPDX-License-Identifier: Apache-2.0
#include "host/measure/converge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/parallel.h"
#include "host/image/image_error.h"
#include "host/image/picture_io.h"
#include "host/scene/scene.h"

namespace rt {

namespace {

double rmse_of(const RenderStats& run) { return run.error ? run.error->rmse : 0; }
double build_of(const RenderStats& run) { return run.phases.renderer.build; }
double open_of(const RenderStats& run) { return run.phases.renderer.open; }

bool same_build(const ConvergeCase& a, const ConvergeCase& b) {
    return a.device == b.device && a.picture.precision == b.picture.precision &&
           a.picture.math == b.picture.math;
}

std::string family_of(const AaMode& aa) {
    const std::string text = to_string(aa);
    return text == "none" ? "grid" : text.substr(0, text.find(':'));
}

/// The value rounded to the three digits that tables show: what nobody sees decides nothing.
double shown(double value) {
    if (!(value > 0) || !std::isfinite(value)) return value;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    return std::round(value / unit) * unit;
}

std::optional<PointFigures> figures_of(const ConvergePoint& point, double floor) {
    if (!point.has_figures()) return std::nullopt;
    PointFigures figures;
    figures.seconds = spread_of(point.repeats, picture_seconds);
    figures.rmse = spread_of(point.repeats, rmse_of).median;
    figures.below_floor = figures.rmse < floor;
    return figures;
}

std::vector<std::size_t> measured_points(const ConvergeResult& result) {
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        if (result.points[i].figures) points.push_back(i);
    }
    return points;
}

/// Costs of the points at these indices, which have figures.
std::vector<Cost> costs_of(const ConvergeResult& result, const std::vector<std::size_t>& points) {
    std::vector<Cost> costs;
    for (const std::size_t i : points) {
        const PointFigures& figures = *result.points[i].figures;
        costs.push_back({figures.seconds.median, figures.rmse});
    }
    return costs;
}

std::vector<Curve> curves_of(const ConvergeResult& result) {
    std::vector<Curve> curves;
    for (const std::size_t i : measured_points(result)) {
        const ConvergeCase& asked = result.points[i].asked;
        const std::string family = family_of(asked.picture.aa);
        auto curve = std::ranges::find_if(curves, [&](const Curve& c) {
            return same_build(c.of, asked) &&
                   c.of.picture.max_bounces == asked.picture.max_bounces && c.family == family;
        });
        if (curve == curves.end()) curve = curves.insert(curve, Curve{asked, family, {}, {}});
        curve->points.push_back(i);
    }
    for (Curve& curve : curves) curve.slope = log_log_slope(costs_of(result, curve.points));
    return curves;
}

std::vector<BuildOffset> build_offsets(const ConvergeResult& result) {
    std::vector<BuildOffset> offsets;
    for (const ConvergePoint& first : result.points) {
        const auto is_same = [&](const BuildOffset& o) { return same_build(o.of, first.asked); };
        if (std::ranges::any_of(offsets, is_same) || first.warm_up.empty()) continue;
        std::vector<TimedRun> repeats;
        for (const ConvergePoint& point : result.points) {
            if (!same_build(point.asked, first.asked)) continue;
            repeats.insert(repeats.end(), point.repeats.begin(), point.repeats.end());
        }
        if (repeats.empty()) continue;
        const RenderStats& run = first.warm_up.front();
        offsets.push_back({first.asked, spread_of(repeats, open_of).median, build_of(run),
                           spread_of(repeats, build_of)});
    }
    return offsets;
}

TargetTime target_time(const ConvergeResult& result, const ConvergeCase& of, double target) {
    TargetTime time{of.device, of.device_name, target, {}, {}, target < result.reference.floor()};
    for (const std::size_t i : measured_points(result)) {
        const PointFigures& figures = *result.points[i].figures;
        if (result.points[i].asked.device != of.device || figures.rmse > target) continue;
        if (time.seconds && figures.seconds.median >= *time.seconds) continue;
        time.point = i;
        time.seconds = figures.seconds.median;
    }
    return time;
}

std::vector<TargetTime> target_times(const ConvergeResult& result) {
    std::vector<TargetTime> times;
    for (const ConvergePoint& point : result.points) {
        if (std::ranges::count(times, point.asked.device, &TargetTime::device) > 0) continue;
        for (const double target : rmse_targets) {
            times.push_back(target_time(result, point.asked, target));
        }
    }
    return times;
}

}  // namespace

void ConvergeResult::summarize() {
    for (ConvergePoint& point : points) point.figures = figures_of(point, reference.floor());
    const std::vector<std::size_t> measured = measured_points(*this);
    front.clear();
    for (const std::size_t i : pareto_front(costs_of(*this, measured))) {
        front.push_back(measured[i]);
    }
    curves = curves_of(*this);
    builds = build_offsets(*this);
    targets = target_times(*this);
}

std::vector<std::size_t> pareto_front(std::span<const Cost> costs) {
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
        return std::pair(shown(costs[i].seconds), shown(costs[i].rmse));
    });
    std::vector<std::size_t> front;
    double best = std::numeric_limits<double>::infinity();
    for (const std::size_t i : order) {
        if (!(shown(costs[i].rmse) < best)) continue;
        best = shown(costs[i].rmse);
        front.push_back(i);
    }
    return front;
}

std::optional<double> log_log_slope(std::span<const Cost> costs) {
    // Relative to the first cost and about the mean: the spread of nearly equal times must not be a
    // small difference of large sums.
    const Cost* first = nullptr;
    std::vector<double> us, vs;
    for (const Cost& cost : costs) {
        if (!(cost.seconds > 0) || !(cost.rmse > 0)) continue;
        if (first == nullptr) first = &cost;
        us.push_back(std::log(cost.seconds / first->seconds));
        vs.push_back(std::log(cost.rmse / first->rmse));
    }
    const double u_mean = std::accumulate(us.begin(), us.end(), 0.0) / us.size();
    const double v_mean = std::accumulate(vs.begin(), vs.end(), 0.0) / vs.size();
    double uu = 0, uv = 0;
    for (std::size_t i = 0; i < us.size(); ++i) {
        uu += (us[i] - u_mean) * (us[i] - u_mean);
        uv += (us[i] - u_mean) * (vs[i] - v_mean);
    }
    if (!(uu > 0)) return std::nullopt;
    return uv / uu;
}

namespace {

struct ConvergedPicture {
    Picture picture;
    ConvergeReference about;
    bool complete = true;  ///< false when a signal stopped it
};

std::string hash_of(const Picture& picture) {
    Hasher hasher;
    hasher.add_bytes(std::as_bytes(std::span(picture.pixels)));
    return hash_text(hasher.value());
}

void check_reference(const Picture& picture, const std::string& name) {
    if (const std::size_t count = count_non_finite(picture); count > 0) {
        throw Error(ExitCode::non_finite,
                    fmt::format("{}: {} not finite; look for very large numbers in the scene", name,
                                counted(count, "pixel is", "pixels are")));
    }
}

constexpr const char* reference_key = "mirrorball:Reference";  ///< ConvergeReference as JSON

/// What an EXR that is kept says of itself; a PFM holds no text.
ConvergeReference read_about(const Scene& scene, const std::string& path,
                             const PictureMetadata& metadata) {
    ConvergeReference about;
    const std::string text = text_in(metadata, reference_key);
    about.max_bounces = scene.max_bounces;
    if (!text.empty()) {
        record::Reader::read(Json::parse(text, nullptr, false), about,
                             fmt::format("{}: {}", path, reference_key));
    }
    const std::string hash = text_in(metadata, scene_hash_key);
    if ((!hash.empty() && hash != hash_text(scene_hash(scene))) ||
        about.max_bounces != scene.max_bounces) {
        throw Error(ExitCode::input, path +
                                         ": the reference of another scene, or with other "
                                         "bounces; name another file");
    }
    about.file = path;
    return about;
}

/// --reference: a picture rendered before.
ConvergedPicture kept_picture(const Scene& scene, const std::string& path) {
    ConvergedPicture kept;
    auto [picture, metadata] = read_picture_file(path);
    kept.picture = std::move(picture);
    check_reference(kept.picture, path);
    if (kept.picture.width != scene.width || kept.picture.height != scene.height ||
        kept.picture.channels != 3) {
        throw Error(ExitCode::input,
                    fmt::format("{}: not {}x{} pixels of 3 channels; render it at the same --size",
                                path, scene.width, scene.height));
    }
    kept.about = read_about(scene, path, metadata);
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
    about.halves = {fmt::format("sobol:{} seed 1", options.reference_samples),
                    fmt::format("sobol:{} seed 2", options.reference_samples)};
    about.hashes = {hash_of(a.picture), hash_of(b.picture)};
    about.max_bounces = scene.max_bounces;
    about.halves_rmse = image_error(clamped(a.picture), clamped(b.picture)).rmse;
    converged.picture = mean_of(a.picture, b.picture);
    about.seconds = watch.seconds();
    if (!options.reference.empty()) {
        const PictureMetadata metadata{{scene_hash_key, hash_text(scene_hash(scene))},
                                       {reference_key, json_of(about).dump()}};
        write_picture(options.reference, converged.picture, Encoding::display, metadata);
    }
    return converged;
}

/// The pictures of one device's sweep, in its order. Omits double on devices without it, and fast
/// math on threads: it is an OpenCL compiler option.
std::vector<PictureSpec> swept_pictures(const ConvergeOptions& options, const Scene& scene,
                                        const std::vector<int>& bounces,
                                        const DeviceChoice& device) {
    std::vector<PictureSpec> pictures;
    PictureSpec picture = picture_spec(scene, {});
    for (const Precision precision : options.precisions) {
        if (precision == Precision::float64 && !device.has_double()) continue;
        for (const Math math : options.math) {
            if (math == Math::fast && device.use_threads) continue;
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
std::vector<TimedCase> plan(const ConvergeOptions& options,
                            const std::vector<DeviceChoice>& devices, const TimedScene& scene,
                            const std::vector<int>& bounces, ConvergeResult& result) {
    std::vector<TimedCase> cases;
    for (const DeviceChoice& device : devices) {
        for (const PictureSpec& picture : swept_pictures(options, scene.scene, bounces, device)) {
            result.points.emplace_back().asked = {device.spec(), device.name(), picture};
            TimedCase& timed = cases.emplace_back();
            timed.scene = &scene;
            timed.device = device;
            timed.settings = timed_settings(settings_for(picture));
            if (device.use_threads && device.threads == 0) {
                timed.settings.threads = options.threads;
            }
        }
    }
    return cases;
}

/// A picture as threads compute it, with an estimate of its error; empty if the render was stopped.
std::optional<RenderStats> picture_of_threads(Scene scene, RenderSettings settings) {
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
            cases[i].right = picture;
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
    // First, for a bad driver may end this process.
    const auto devices = listed_devices(options.devices);
    TimedScene loaded = load_timed_scene(options.scene, options.light, options.quiet);
    Scene& scene = loaded.scene;
    say_busy(options.quiet);
    if (options.size) set_image_size(scene, options.size->width, options.size->height);
    result.scene = loaded.id = {options.scene, scene.name, scene_hash(scene)};
    result.width = scene.width;
    result.height = scene.height;
    std::vector<int> bounces = options.max_bounces;
    if (bounces.empty()) bounces.push_back(scene.max_bounces);
    std::vector<TimedCase> cases = plan(options, devices, loaded, bounces, result);
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
