// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/picture_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <type_traits>
#include <utility>

#include "host/console.h"
#include "host/error.h"
#include "host/memory_limit.h"
#include "host/render/cl_renderer.h"
#include "host/render/device_spec.h"
#include "host/render/picture_loop.h"
#include "host/render/pocl_threads.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene_hash.h"
#include "host/stop_signal.h"
#include "host/verbs/progress.h"

namespace rt {

namespace {

DeviceChoice chosen_device(const RenderOptions& options) {
    if (const auto choice = choose_without_opencl(options.device)) {
        if (choice->threads > 0 && options.threads > 0 && choice->threads != options.threads) {
            throw Error(ExitCode::usage,
                        fmt::format("--threads {} and --device {} disagree; give one",
                                    options.threads, options.device));
        }
        return *choice;
    }
    std::vector<std::string> problems;
    const std::vector<ClDevice> devices = list_cl_devices(problems);
    restore_stop_signals();
    return choose_device(options.device, devices, problems);
}

Rect chosen_region(const Scene& scene, const RenderOptions& options) {
    const Rect whole{0, 0, scene.width, scene.height};
    if (!options.crop) return whole;
    const Rect& crop = *options.crop;
    if (crop.x + crop.width > whole.width || crop.y + crop.height > whole.height) {
        throw Error(
            ExitCode::usage,
            fmt::format("--crop reaches to {},{}, beyond the picture of {}x{} pixels",
                        crop.x + crop.width, crop.y + crop.height, whole.width, whole.height));
    }
    return crop;
}

SceneStats scene_stats(const Scene& scene) {
    SceneStats stats;
    stats.name = scene.name;
    stats.hash = scene_hash(scene);
    stats.spheres = scene.spheres.size();
    stats.cones = scene.cones.size();
    stats.triangles = triangle_count(scene);
    stats.smooth_triangles = static_cast<std::size_t>(std::count_if(
        scene.triangles.begin(), scene.triangles.end(),
        [](const Scene::Triangle& triangle) { return triangle.normals.has_value(); }));
    stats.lights = scene.lights.size();
    stats.materials = scene.materials.size();
    return stats;
}

/// One flattened scene being rendered in the precision of T, with what is found out on the way.
template <typename T>
class Job {
   public:
    Job(const Scene& scene, const RenderOptions& options)
        : options_(options),
          region_(chosen_region(scene, options)),
          rendered_(region_to_render(scene.aa, region_, scene.width, scene.height)) {
        const Stopwatch watch;
        FlattenOptions flatten_options;
        flatten_options.hierarchies = options.hierarchies;
        flatten_options.caster_lists = options.caster_lists;
        scene_ = flatten<T>(scene, flatten_options);
        stats_.phases.flatten = watch.seconds();
        stats_.scene = scene_stats(scene);
        stats_.scene.triangles = scene_.triangles.size();
        stats_.scene.smooth_triangles = scene_.vertex_normals.size();
        stats_.scene.bytes = scene_.bytes();
        stats_.scene.flatten = scene_.stats;
        stats_.width = scene.width;
        stats_.height = scene.height;
        stats_.region = region_;
        stats_.aa = scene.aa;
        stats_.filter = scene.filter;
        stats_.max_bounces = scene.max_bounces;
        stats_.double_precision = sizeof(T) == sizeof(double);
        stats_.fast_math = options.fast_math;
        stats_.features = scene_.features;
        stats_.all_features = options.all_features;
        stats_.also_features = options.also_features;
        stats_.hierarchies = options.hierarchies;
        stats_.caster_lists = options.caster_lists;
    }

    RenderedPicture run(std::future<DeviceChoice> device) {
        const Stopwatch watch;
        const DeviceChoice choice = device.get();
        const double wait_seconds = watch.seconds();
        say_ignored_options(choice);
        if (!choice.note.empty()) say(choice.note);
        if (choice.use_threads) {
            render_on_threads(choice.threads);
        } else {
            render_on_device(choice.device);
        }
        stats_.phases.renderer.open += wait_seconds;
        return finished_picture();
    }

   private:
    /// Options that mean nothing on the chosen device are named, not dropped in silence.
    void say_ignored_options(const DeviceChoice& choice) const {
        if (choice.use_threads && options_.launch != Launch::automatic) {
            say("--launch is for OpenCL devices; threads ignore it");
        }
        if (choice.use_threads && options_.fast_math) {
            say("--math fast is for OpenCL devices; threads are strict");
        }
        if (!choice.use_threads && options_.schedule != Schedule::tiles) {
            say("--schedule is for --device threads; OpenCL devices ignore it");
        }
        const bool is_pocl = choice.device.platform == pocl_platform;
        if (!choice.use_threads && options_.threads > 0 && !is_pocl) {
            say("--threads is for --device threads and PoCL; " + choice.device.name +
                " ignores it");
        }
    }

    void say(const std::string& line) const {
        if (!options_.quiet) print_message("mirrorball: " + line + "\n");
    }

    void render_on_device(const ClDevice& device) {
        ClOptions cl_options;
        cl_options.launch = options_.launch;
        cl_options.lanes = options_.lanes;
        cl_options.fast_math = options_.fast_math;
        cl_options.will_refine = stats_.aa.refines();
        cl_options.all_features = options_.all_features;
        cl_options.also = options_.also_features;
        cl_options.any_samples = options_.any_samples;
        if (!options_.fast_math && !device.rounds_correctly) {
            say_verbose(device.name +
                        " does not promise correctly rounded division and square "
                        "root; the picture's bits may differ from other devices'");
        }
        try {
            const auto renderer = make_cl_renderer(scene_, device, cl_options);
            render_with(*renderer);
        } catch (const Error& error) {
            if (error.exit_code() != ExitCode::device || options_.no_fallback) throw;
            const std::string what = error.what();
            say(options_.verbose ? what : what.substr(0, what.find('\n')));
            say("rendering on threads instead");
            render_on_threads(0);
            stats_.device.fallback_from = device.name;
            return;
        }
        stats_.device.name = device.name;
        stats_.device.platform = device.platform;
        stats_.device.driver = device.driver;
        stats_.device.launch = launches_samples(options_.launch, device) ? "sample" : "pixel";
        stats_.device.lanes = options_.precision == Precision::float32
                                  ? packet_lanes<float>(options_.lanes, device)
                                  : packet_lanes<double>(options_.lanes, device);
    }

    void say_verbose(const std::string& line) const {
        if (options_.verbose) say(line);
    }

    void render_on_threads(int threads) {
        ThreadsOptions threads_options;
        threads_options.threads = threads > 0 ? threads : options_.threads;
        threads_options.schedule = options_.schedule;
        threads_options.lanes = options_.lanes;
        threads_options.all_features = options_.all_features;
        threads_options.also = options_.also_features;
        threads_options.any_samples = options_.any_samples;
        threads_options.isa = options_.isa;
        const NativeKernels<T>& kernels = native_kernels_for(scene_, threads_options);
        stats_.device.lanes = kernels.lanes;
        stats_.device.isa = kernels.isa;
        stats_.device.name = "threads";
        stats_.device.threads = thread_count(threads_options, stats_.aa.samples());
        stats_.device.schedule = options_.schedule == Schedule::tiles ? "tiles" : "buffers";
        render_with(*make_threads_renderer(scene_, threads_options));
    }

    void render_with(Renderer<T>& renderer) {
        install_stop_signals();
        check_memory(
            static_cast<std::uint64_t>(rendered_.pixels()) * 3 * (sizeof(T) + sizeof(float)),
            fmt::format("the film of {}x{} pixels, with its file", rendered_.width,
                        rendered_.height),
            "make it smaller with --size, or render parts with --crop");
        film_ = Film<T>(rendered_.width, rendered_.height);
        const PictureSize tile = tile_size(renderer);
        TileQueue queue(make_tiles(rendered_, tile.width, tile.height), stop_flag());
        {
            const ProgressReporter progress(queue, progress_mode_for_stderr(options_));
            stats_.refined = render_all(renderer, stats_.aa, queue, rendered_, film_);
        }
        film_ = part_of(film_, rendered_, region_);
        stats_.phases.renderer = renderer.times();
        stats_.rays = queue.rays();
        stats_.tiles = queue.tiles().size();
        stats_.tiles_finished = queue.tiles_finished();
    }

    /// The tile asked for, cut down to the region and to what the renderer takes.
    PictureSize tile_size(const Renderer<T>& renderer) const {
        const Rect own = renderer.tile_size(rendered_.width);
        const PictureSize asked = options_.tile.value_or(PictureSize{own.width, own.height});
        const auto most = static_cast<int>(
            std::min<std::int64_t>(renderer.most_tile_pixels(), rendered_.pixels()));
        const int width = std::min({asked.width, rendered_.width, most});
        return {width, std::min({asked.height, rendered_.height, most / width})};
    }

    RenderedPicture finished_picture() {
        stats_.image_hash = hash_of(film_);
        RenderedPicture rendered;
        rendered.picture.width = film_.width;
        rendered.picture.height = film_.height;
        if constexpr (std::is_same_v<T, float>) {
            rendered.picture.pixels = std::move(film_.rgb);
        } else {
            rendered.picture.pixels.assign(film_.rgb.begin(), film_.rgb.end());
        }
        stats_.non_finite = count_non_finite(rendered.picture);
        rendered.stats = stats_;
        return rendered;
    }

    const RenderOptions& options_;
    const Rect region_;    ///< asked for
    const Rect rendered_;  ///< that, and what it takes to refine it
    FlatScene<T> scene_;
    Film<T> film_{0, 0};
    RenderStats stats_;
};

}  // namespace

namespace {

/// The cubic has negative weights: a handful of scattered samples may add up to nothing.
void check_filter(const Scene& scene) {
    constexpr int fewest = 16;
    if (scene.filter == Filter::mitchell && scene.aa.pattern == AaMode::Pattern::sobol &&
        scene.aa.count < fewest) {
        throw Error(ExitCode::usage, fmt::format("--filter mitchell needs at least sobol:{}; {} "
                                                 "is too few",
                                                 fewest, to_string(scene.aa)));
    }
}

}  // namespace

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) print_message("mirrorball: " + note + "\n");
}

void apply_overrides(Scene& scene, const RenderOptions& options) {
    if (options.size) set_image_size(scene, options.size->width, options.size->height);
    if (options.aa) scene.aa = *options.aa;
    scene.filter = options.filter;
    scene.sampling_seed = options.sampling_seed;
    check_filter(scene);
    if (options.max_bounces) scene.max_bounces = *options.max_bounces;
}

std::future<DeviceChoice> find_device(const RenderOptions& options) {
    const auto choose = [options] { return chosen_device(options); };
    if (!choose_without_opencl(options.device)) {
        set_pocl_threads(options.threads);
        try {
            return std::async(std::launch::async, choose);
        } catch (const std::system_error&) {  // no thread is to be had: later, then
        }
    }
    return std::async(std::launch::deferred, choose);
}

RenderedPicture render_picture(const Scene& scene, const RenderOptions& options,
                               std::future<DeviceChoice> device) {
    if (options.precision == Precision::float64) {
        return Job<double>(scene, options).run(std::move(device));
    }
    return Job<float>(scene, options).run(std::move(device));
}

RenderedPicture render_picture(const Scene& scene, const RenderOptions& options) {
    return render_picture(scene, options, find_device(options));
}

}  // namespace rt
