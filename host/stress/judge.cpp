// SPDX-License-Identifier: Apache-2.0
#include "host/stress/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <span>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/image/false_color.h"
#include "host/image/picture_io.h"
#include "host/measure/timing.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/devices.h"
#include "host/picture/crew.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"

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

namespace {

RenderSettings row_settings(const StressRow& row, const StressOptions& stress) {
    RenderSettings settings = timed_settings();
    settings.precision = row.precision;
    if (stress.quick || stress.all_features) settings.kernels.features = every_feature;
    return settings;
}

/// Traces a trial's rays on the device that renders its pictures.
RayCaster ray_caster(const DeviceChoice& choice, const std::shared_ptr<OpenDevices>& open) {
    if (choice.use_threads) return threads_ray_caster();
    const ClOptions options{.open_devices = open};
    const auto make = [device = choice.device, options](const auto& scene) {
        return [tracer = make_cl_ray_tracer(scene, device, options)](auto queries, auto answers) {
            tracer(queries, answers);
            note_worker_progress();
        };
    };
    return {make, make};
}

/// The text as part of a file name: '/', '^' and blanks become '-'.
std::string file_stem(std::string text) {
    for (char& c : text) {
        if (c == '/' || c == '^' || c == ' ') c = '-';
    }
    return text;
}

/// How bad a picture is, among those of a case.
double badness_of(const PictureFigures& figures) {
    return 1e6 * static_cast<double>(figures.nans + figures.wrong) +
           static_cast<double>(figures.wrong_at_edges) + figures.max_error;
}

/// Writes STEM.worst.png and, with a reference, STEM.reference.png and STEM.error.png. Throws Error
/// (ExitCode::output).
void write_pictures(const std::string& stem, const Picture& worst,
                    const std::optional<ReferencePicture>& reference) {
    write_picture(stem + ".worst.png", worst, Encoding::display);
    if (!reference) return;
    const Picture right = reference->as_picture();
    write_picture(stem + ".reference.png", right, Encoding::display);
    write_picture(stem + ".error.png", heat_map(clamped(worst), clamped(right), 1.0 / 255),
                  Encoding::display);
}

class Runner {
   public:
    Runner(const StressOptions& options, RenderCache& cache)
        : options_(options), cache_(cache), devices_(listed_devices(options.devices)) {
        if (devices_.empty())
            throw Error(ExitCode::device, "no usable device; see 'mirrorball devices'");
    }

    StressFamilyResult run(const StressFamily& family) {
        StressFamilyResult result{family.name, family.parameter, family.why, {}};
        first_hashes_.clear();
        for (const StressCase& one : family.cases) {
            if (stop_flag() != 0) break;
            StressCaseResult done{one.label, one.value, one.tolerance, {}, "", 0};
            std::visit([&](const auto& trial) { run_trial(family, one, trial, done); }, one.trial);
            compare_hashes(done);
            result.cases.push_back(std::move(done));
        }
        return result;
    }

   private:
    /// Adds a row for each device and precision, filled in by measure(device, row), until a signal.
    template <typename Measure>
    void add_rows(const StressCase& one, std::vector<StressRow>& rows, const Measure& measure) {
        for (const DeviceChoice& device : devices_) {
            for (const Precision precision : {Precision::float32, Precision::float64}) {
                const bool is_double = precision == Precision::float64;
                if (is_double && !device.has_double()) continue;
                StressRow row;
                row.renderer = device.name();
                row.device = device.spec();
                row.precision = precision;
                row.judged = is_double || one.tolerance.in_float;
                try {
                    measure(device, row);
                } catch (const Error& error) {
                    row.why = first_line(error.what());
                    row.judged = true;
                }
                if (stop_flag() != 0) return;
                rows.push_back(std::move(row));
            }
        }
    }

    void run_trial(const StressFamily& family, const StressCase& one, const PictureTrial& trial,
                   StressCaseResult& result) {
        const Scene scene = trial.scene();
        const Stopwatch watch;
        std::optional<ReferencePicture> reference;
        if (trial.reference != ReferenceKind::none) {
            reference.emplace(trial.reference_scene.value_or(scene), trial.reference);
        }
        result.reference_seconds = watch.seconds();
        std::optional<Picture> worst;
        double badness = 0;
        add_rows(one, result.rows, [&](const DeviceChoice& device, StressRow& row) {
            const RenderedPicture rendered =
                render_quietly(scene, row_settings(row, options_), device, &cache_);
            if (!rendered.stats.complete()) return;
            row.seconds = rendered.stats.phases.renderer.trace;
            row.figures = reference ? judge_stress_picture(rendered.picture, *reference)
                                    : count_non_numbers(rendered.picture);
            row.figures.hash = rendered.stats.image_hash;
            row.why = exceeded_tolerance(row.figures, one.tolerance);
            if (!worst || badness_of(row.figures) > badness) {
                worst = rendered.picture;
                badness = badness_of(row.figures);
            }
            check_same_bits(trial, row);
        });
        if (options_.output.empty() || !worst) return;
        write_pictures(options_.output + "/" + file_stem(family.name + "-" + one.label), *worst,
                       reference);
    }

    /// Checks that a row has the same bits as the family's first on this renderer.
    void check_same_bits(const PictureTrial& trial, StressRow& row) {
        if (!trial.same_bits || !row.why.empty()) return;
        const auto first =
            first_hashes_.try_emplace({row.device, row.precision}, row.figures.hash).first;
        if (first->second != row.figures.hash) row.why = "bits differ from the first case";
    }

    void run_trial(const StressFamily&, const StressCase& one, const RayTrial& trial,
                   StressCaseResult& result) {
        const std::uint64_t rays = options_.quick ? trial.quick_rays : trial.rays;
        add_rows(one, result.rows, [&](const DeviceChoice& device, StressRow& row) {
            const Stopwatch watch;
            const DriverTask task(device.use_threads ? "" : row.renderer);
            row.rays = trial.run(rays, ray_caster(device, cache_.devices), row.precision);
            StressTolerance tolerance = one.tolerance;
            if (row.precision == Precision::float64) {  // more than float can reach
                tolerance.max_error = std::min(tolerance.max_error, 1e-9);
                if (tolerance.most_wrong < rays)
                    tolerance.most_wrong = std::min<std::size_t>(tolerance.most_wrong, 4);
            }
            row.why = exceeded_tolerance(*row.rays, tolerance);
            row.seconds = watch.seconds();
        });
    }

    /// In strict arithmetic all devices that give a picture give the same bits.
    static void compare_hashes(StressCaseResult& result) {
        for (const Precision precision : {Precision::float32, Precision::float64}) {
            std::set<std::uint64_t> hashes;
            for (const StressRow& row : result.rows) {
                if (row.figures.hash == 0 || row.precision != precision) continue;
                hashes.insert(row.figures.hash);
            }
            if (hashes.size() < 2) continue;
            result.disagreement = fmt::format("devices give {} different pictures in {}",
                                              hashes.size(), to_string(precision));
        }
    }

    const StressOptions& options_;
    RenderCache& cache_;
    const std::vector<DeviceChoice> devices_;
    /// Of each renderer's first picture of a family whose pictures must agree in every bit.
    std::map<std::pair<std::string, Precision>, std::uint64_t> first_hashes_;
};

}  // namespace

StressResult run_stress_cases(const std::vector<StressFamily>& families,
                              const StressOptions& options, RenderCache& cache) {
    StressResult result;
    other_load();
    result.quick = options.quick;
    const Stopwatch watch;
    Runner runner(options, cache);
    install_stop_signals();
    for (const StressFamily& family : families) {
        if (!options.quiet) {
            print_note(fmt::format("{}, {}", family.name, counted(family.cases.size(), "case")));
        }
        StressFamilyResult done = runner.run(family);
        if (stop_flag() != 0) break;  // it may be unfinished: no verdict
        result.families.push_back(std::move(done));
    }
    result.interrupted = stop_flag() != 0;
    result.unfinished = families.size() - result.families.size();
    result.seconds = watch.seconds();
    result.load_before = other_load();
    return result;
}

}  // namespace rt
