// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/cl_renderer.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <deque>
#include <span>
#include <thread>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/opencl/opencl.h"
#include "host/render/tile_rounds.h"

namespace rt {

namespace {

/// Work items per group: for single rays, and for packets, which are wide enough on their own
/// (Intel's compiler would vectorize them again and slow them down).
constexpr std::size_t single_group = 64;
constexpr std::size_t packet_group = 1;

/// Samples of the first launch, when nothing is known yet, and of the largest.
constexpr std::int64_t cpu_first_samples = 1 << 17, cpu_most_samples = 1 << 22;
constexpr std::int64_t gpu_first_samples = 1 << 20, gpu_most_samples = 1 << 24;

/// Work items that a GPU's compute unit runs at once.
constexpr std::int64_t unit_items = 2048;

/// One runs and one waits; more would only delay an interrupt.
constexpr std::size_t launches_in_flight = 2;
constexpr double progress_seconds = 0.2;

/// Of a GPU's ray counts, to which the others are added before they are read back.
constexpr std::size_t kept_slots = 4096;

/// The longest pause between two looks at a launch.
constexpr std::chrono::duration<double> longest_pause{2e-3};

std::size_t divided_up(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

/// The seconds that a command took, by the device's profiling clock.
double device_seconds(const cl::Event& event) {
    const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return static_cast<double>(end - start) * 1e-9;
}

/// Waits without using the processor, as a driver that waits busily would: threads get it, and a
/// launch that never ends is not taken for work (host/process/worker.h).
void wait_idly(const cl::Event& event) {
    std::chrono::duration<double> pause{20e-6};
    while (event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() > CL_COMPLETE) {
        std::this_thread::sleep_for(pause);
        pause = std::min(pause * 1.125, longest_pause);
    }
}

/// A black film on a device: the film's own memory on a CPU that renders alone (if the driver
/// supports that), else a copy that is read back rectangle by rectangle. The film must outlive it.
/// Throws Error (ExitCode::limit) if it exceeds the device's largest allocation.
template <typename T>
class ClFilm {
   public:
    ClFilm(Film<T>& film, const cl::Context& context, const cl::CommandQueue& queue,
           const ClDevice& device, bool is_shared)
        : film_(film), queue_(queue), is_shared_(is_shared) {
        const cl_mem_flags shared = is_shared_ ? CL_MEM_USE_HOST_PTR : 0;
        buffer_ = make_cl_buffer(context, device, bytes(), "the film", CL_MEM_READ_WRITE | shared,
                                 is_shared_ ? film.rgb.data() : nullptr);
        if (!is_shared_) queue_.enqueueFillBuffer(buffer_, T(0), 0, bytes());
    }
    /// Waits: commands in flight write to the film's memory.
    ~ClFilm() {
        if (is_shared_) clFinish(queue_());
    }
    ClFilm(const ClFilm&) = delete;
    ClFilm& operator=(const ClFilm&) = delete;

    const cl::Buffer& buffer() const { return buffer_; }

    /// Copies a rectangle of the film, finished on the device, back; waits for nothing else.
    void read_back(const Rect& rect, const cl::CommandQueue& reads) {
        const std::size_t pixel = 3 * sizeof(T),
                          row = pixel * static_cast<std::size_t>(film_.width);
        if (is_shared_) {
            void* const mapped = reads.enqueueMapBuffer(
                buffer_, CL_TRUE, CL_MAP_READ, row * static_cast<std::size_t>(rect.y),
                row * static_cast<std::size_t>(rect.height));
            reads.enqueueUnmapMemObject(buffer_, mapped);
            reads.finish();
            return;
        }
        if (rect.width == film_.width) {
            const std::size_t at = 3 * static_cast<std::size_t>(rect.y * film_.width);
            reads.enqueueReadBuffer(buffer_, CL_TRUE, at * sizeof(T),
                                    row * static_cast<std::size_t>(rect.height), &film_.rgb[at]);
            return;
        }
        const std::array<std::size_t, 3> corner{pixel * static_cast<std::size_t>(rect.x),
                                                static_cast<std::size_t>(rect.y), 0};
        const std::array<std::size_t, 3> size{pixel * static_cast<std::size_t>(rect.width),
                                              static_cast<std::size_t>(rect.height), 1};
        reads.enqueueReadBufferRect(buffer_, CL_TRUE, corner, corner, size, row, 0, row, 0,
                                    film_.rgb.data());
    }

    /// Brings back a film in shared memory.
    void finish() {
        if (!is_shared_) return;
        void* const mapped = queue_.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ, 0, bytes());
        queue_.enqueueUnmapMemObject(buffer_, mapped);
        queue_.finish();
    }

   private:
    std::size_t bytes() const { return film_.rgb.size() * sizeof(T); }

    Film<T>& film_;
    const cl::CommandQueue& queue_;
    const bool is_shared_;
    cl::Buffer buffer_;
};

template <typename T>
class ClRenderer : public Renderer<T> {
   public:
    ClRenderer(const FlatScene<T>& scene, const ClDevice& device, const ClOptions& options)
        : device_(device),
          options_(options),
          programs_(*options_.open_devices),
          params_(scene.params),
          pacer_(device.is_cpu() ? cpu_first_samples : gpu_first_samples,
                 device.is_cpu() ? cpu_most_samples : gpu_most_samples,
                 device.is_cpu() ? 1 : unit_items * device.compute_units) {
        launch_samples_ = launches_samples(options.kernels.launch, device, in_rounds());
        lanes_ = packet_lanes<T>(options.kernels.lanes, device);
        group_ = picture_group(options.kernels, lanes_);
        try {
            open();
            upload(scene);
            build(picture_program(scene, device, options));
        } catch (const cl::Error& error) {
            throw_device_error(device_, error);
        }
    }

    TileSizes tile_sizes(int film_width) const override {
        return cl_tile_sizes<T>(params_, device_, options_, film_width);
    }

    void render(TileQueue& queue, const Rect& region, Film<T>& film) override {
        try {
            const Stopwatch watch;
            const double read_before = times_.read_back;
            ClFilm<T> on_device(film, context_, queue_, device_,
                                device_.is_cpu() && !options_.shares_film);
            Progress progress{queue, on_device, {}};
            const RayCounts counted_before = counted_;
            try {
                trace_tiles(progress, region);
                const Stopwatch finishing;
                on_device.finish();
                times_.read_back += finishing.seconds();
            } catch (...) {
                queue.add_rays(counted_before - counted_);  // negative: those of others remain
                for (const InFlight& launch : progress.in_flight) queue.give_back(launch.run);
                throw;
            }
            times_.trace += watch.seconds() - (times_.read_back - read_before);
        } catch (const cl::Error& error) {
            throw_device_error(device_, error);
        }
    }

    RendererTimes times() const override { return times_; }

   private:
    using FlatTile = typename Flat<T>::Tile;
    using FlatCounts = typename Flat<T>::RayCounts;

    struct InFlight {
        TileRun run;
        std::vector<cl::Event> events;
    };

    /// The state of one call of render.
    struct Progress {
        TileQueue& queue;
        ClFilm<T>& film;
        std::deque<InFlight> in_flight;
    };

    bool in_rounds() const { return renders_in_rounds(params_); }
    int margin() const { return tile_margin(params_); }
    int rounds() const { return round_count(params_); }
    /// Of a pixel, for the pacer.
    std::int64_t paced_samples() const {
        return in_rounds() ? round_samples_guess : static_cast<std::int64_t>(params_.samples);
    }
    std::size_t samples() const { return static_cast<std::size_t>(params_.samples); }

    PacketShape shape(std::size_t samples) const {
        return packet_shape(lanes_, static_cast<int>(samples));
    }

    /// Whether a rectangle is small enough for one launch.
    bool fits(const Rect& rect) const {
        const std::int64_t traced = rect.pixels() * paced_samples();
        if (traced > pacer_.samples()) return false;
        if (launch_samples_) return traced <= static_cast<std::int64_t>(most_items(device_));
        const FlatTile tile = flat_tile<T>(rect, rect);
        if (!in_rounds()) return packets(tile, shape(samples())) <= most_items(device_);
        const FlatTile first_round = size_with_margin(tile, rounds() - 1);
        return packets(size_with_margin(tile, margin()), shape(1)) <= most_items(device_) &&
               packets(first_round, {1, lanes_, 1}) <= most_items(device_);
    }

    /// Packets that cover a tile.
    std::size_t packets(const FlatTile& tile, const PacketShape& shape) const {
        return divided_up(static_cast<std::size_t>(tile.width),
                          static_cast<std::size_t>(shape.width)) *
               divided_up(static_cast<std::size_t>(tile.height),
                          static_cast<std::size_t>(shape.height));
    }

    void enqueue(const cl::Kernel& kernel, std::size_t items, cl::Event& event) {
        const std::size_t whole_groups =
            std::max<std::size_t>(divided_up(items, group_), 1) * group_;
        used_slots_ = std::max(used_slots_, whole_groups);
        queue_.enqueueNDRangeKernel(kernel, cl::NullRange, whole_groups, group_, nullptr, &event);
    }

    std::size_t count_slots() const { return most_items(device_) + group_; }

    void open() {
        const Stopwatch watch;
        const cl::Device device = handle_of(device_);
        context_ = programs_.context(device_);
        queue_ = cl::CommandQueue(context_, device, CL_QUEUE_PROFILING_ENABLE);
        reads_ = cl::CommandQueue(context_, device);
        times_.open = watch.seconds();
    }

    cl::Buffer make_buffer(std::size_t bytes, const char* what,
                           cl_mem_flags flags = CL_MEM_READ_WRITE) const {
        return make_cl_buffer(context_, device_, bytes, what, flags);
    }

    void upload(const FlatScene<T>& scene) {
        const Stopwatch watch;
        scene_ = upload_scene(scene, context_, queue_, device_);
        const std::size_t count_bytes = count_slots() * sizeof(FlatCounts);
        counts_ = make_buffer(count_bytes, "the ray counts");
        queue_.enqueueFillBuffer(counts_, std::uint64_t{0}, 0, count_bytes);
        if (launch_samples_) {
            samples_ = make_buffer(most_items(device_) * 3 * sizeof(T), "the samples");
        }
        times_.upload = watch.seconds();
    }

    /// Builds the program and launches each kernel once over an empty tile, since some drivers
    /// finish compiling only then.
    void build(const ProgramOptions& options) {
        const Stopwatch watch;
        const cl::Program program = programs_.program(device_, render_kernels, options);
        render_ = cl::Kernel(program, in_rounds()       ? "render_centers"
                                      : launch_samples_ ? "render_samples"
                                                        : "render_pixels");
        set_scene_arguments(render_, params_);
        if (in_rounds()) {
            round_ = cl::Kernel(program, "render_round");
            set_scene_arguments(round_, params_);
        }
        if (launch_samples_) {
            resolve_ = cl::Kernel(program, "resolve_samples");
            resolve_.setArg(1, samples_);
            resolve_.setArg(2, params_);
        }
        sum_counts_ = cl::Kernel(program, "sum_counts");
        sum_counts_.setArg(0, counts_);
        sum_counts_.setArg(2, static_cast<typename Flat<T>::Index>(kept_slots));
        for (const cl::Kernel* kernel : {&render_, &round_, &resolve_}) {
            if ((*kernel)() != nullptr) group_ = fitting_group(*kernel, device_, group_);
        }
        FlatTile nothing{};
        nothing.width = 1;  // kernels divide by the width
        launch(nothing, cl::Buffer());
        queue_.finish();
        times_.build = watch.seconds();
    }

    /// Sets all arguments that stay the same for a picture; the tile's comes next.
    void set_scene_arguments(cl::Kernel& kernel, const typename Flat<T>::LaunchParams& params) {
        kernel.setArg(1, counts_);
        const cl_uint params_argument = set_arguments(kernel, 2, scene_);
        kernel.setArg(params_argument, params);
        tile_argument_ = params_argument + 1;
    }

    /// Enqueues the kernels of one tile.
    std::vector<cl::Event> launch(const FlatTile& tile, const cl::Buffer& film) {
        if (in_rounds()) return launch_rounds(tile, film);
        std::vector<cl::Event> events(launch_samples_ ? 2 : 1);
        render_.setArg(0, launch_samples_ ? samples_ : film);
        render_.setArg(tile_argument_, tile);
        const PacketShape packet = shape(samples());
        const std::size_t rounds =
            launch_samples_ ? samples() / static_cast<std::size_t>(packet.samples) : 1;
        enqueue(render_, packets(tile, packet) * rounds, events[0]);
        if (launch_samples_) {
            resolve_.setArg(0, film);
            resolve_.setArg(3, tile);
            enqueue(resolve_, packets(tile, shape(1)), events[1]);
        }
        queue_.flush();
        return events;
    }

    std::vector<cl::Event> launch_rounds(const FlatTile& tile, const cl::Buffer& film) {
        const std::size_t bytes = plane_values(params_, tile, lanes_) * sizeof(T);
        if (bytes > plane_bytes_) {
            planes_ = make_buffer(bytes, "the pixels' centers");
            plane_bytes_ = bytes;
        }
        std::vector<cl::Event> events(1 + rounds());
        render_.setArg(0, planes_);
        render_.setArg(tile_argument_, tile);
        enqueue(render_, packets(size_with_margin(tile, margin()), shape(1)), events[0]);
        round_.setArg(0, film);
        round_.setArg(tile_argument_, tile);
        round_.setArg(tile_argument_ + 1, planes_);
        for (int round = 0; round < rounds(); ++round) {
            round_.setArg(tile_argument_ + 2, static_cast<typename Flat<T>::Index>(round));
            const FlatTile wide = size_with_margin(tile, rounds() - 1 - round);
            enqueue(round_, packets(wide, {1, lanes_, 1}), events[1 + round]);
        }
        queue_.flush();
        return events;
    }

    void trace_tiles(Progress& progress, const Rect& region) {
        Stopwatch since_count;
        const auto fits_here = [&](const Rect& rect) { return fits(rect); };
        while (const auto run = progress.queue.next_run(fits_here)) {
            InFlight& newest = progress.in_flight.emplace_back(InFlight{*run, {}});
            newest.events = launch(flat_tile<T>(run->whole, region), progress.film.buffer());
            if (progress.in_flight.size() < launches_in_flight) continue;
            finish_oldest(progress, region);
            if (since_count.seconds() < progress_seconds) continue;
            count_rays(progress);
            since_count.lap();
        }
        while (!progress.in_flight.empty()) finish_oldest(progress, region);
        count_rays(progress);
    }

    /// Reads the oldest launch back while the next one runs.
    void finish_oldest(Progress& progress, const Rect& region) {
        const InFlight& oldest = progress.in_flight.front();
        if (!device_.is_cpu()) wait_idly(oldest.events.back());
        oldest.events.back().wait();
        double kernel = device_seconds(oldest.events.front());
        for (std::size_t i = 1; i < oldest.events.size() && in_rounds(); ++i) {
            kernel += device_seconds(oldest.events[i]);
        }
        times_.kernel += kernel;
        if (launch_samples_) times_.resolve += device_seconds(oldest.events.back());
        const Rect& whole = oldest.run.whole;
        const Stopwatch reading;
        progress.film.read_back({whole.x - region.x, whole.y - region.y, whole.width, whole.height},
                                reads_);
        if (progress.in_flight.size() == 1) times_.read_back += reading.seconds();
        const auto traced = static_cast<std::uint64_t>(whole.pixels()) * samples();
        primary_ += traced;
        times_.pixels += whole.pixels();
        pacer_.note(whole.pixels() * paced_samples(), kernel);
        progress.queue.finish(oldest.run);
        progress.in_flight.pop_front();
    }

    /// Adds to the queue the rays traced since the last call.
    void count_rays(const Progress& progress) {
        if (!device_.is_cpu() && used_slots_ > kept_slots) {
            sum_counts_.setArg(1, static_cast<typename Flat<T>::Index>(used_slots_));
            queue_.enqueueNDRangeKernel(sum_counts_, cl::NullRange, kept_slots);
            used_slots_ = kept_slots;
        }
        const auto& launches = progress.in_flight;
        if (!device_.is_cpu() && !launches.empty()) wait_idly(launches.back().events.back());
        auto* const mapped = static_cast<FlatCounts*>(queue_.enqueueMapBuffer(
            counts_, CL_TRUE, CL_MAP_READ, 0, used_slots_ * sizeof(FlatCounts)));
        RayCounts total;
        total.primary = primary_;  // and those that kernels add
        for (const FlatCounts& slot : std::span(mapped, used_slots_)) {
            total.primary += slot.primary;
            total.shadow += slot.shadow;
            total.mirror += slot.mirror;
            total.transmitted += slot.transmitted;
        }
        queue_.enqueueUnmapMemObject(counts_, mapped);
        progress.queue.add_rays(total - counted_);
        counted_ = total;
    }

    const ClDevice device_;
    const ClOptions options_;
    OpenDevices& programs_;
    typename Flat<T>::LaunchParams params_;
    bool launch_samples_ = false;
    int lanes_ = 1;
    std::size_t group_ = 1;  ///< work items per group
    LaunchPacer pacer_;
    cl::Context context_;
    cl::CommandQueue queue_, reads_;
    cl::Kernel render_, resolve_, round_, sum_counts_;
    std::vector<cl::Buffer> scene_;
    cl::Buffer counts_, samples_;
    cl::Buffer planes_;  ///< of a tile and its margin (kernels/planes.cl)
    std::size_t plane_bytes_ = 0;
    cl_uint tile_argument_ = 0;
    std::size_t used_slots_ = 0;  ///< of counts_, so far
    std::uint64_t primary_ = 0;
    RayCounts counted_;
    RendererTimes times_;
};

}  // namespace

template <typename T>
ProgramOptions picture_program(const FlatScene<T>& scene, const ClDevice& device,
                               const ClOptions& options) {
    const KernelChoice& kernels = options.kernels;
    const bool in_rounds = renders_in_rounds(scene.params);
    const bool finds_edges = scene.params.tolerance > 0;
    const bool by_samples = launches_samples(kernels.launch, device, in_rounds);
    const bool by_pixels = !by_samples && !in_rounds;
    ProgramOptions program;
    program.precision = precision_of<T>;
    program.lanes = packet_lanes<T>(kernels.lanes, device);
    program.math = options.math;
    program.entries = {by_pixels, by_samples, false, in_rounds && !finds_edges, finds_edges};
    program.features = scene.features | kernels.features;
    program.more = kernels.cl_options;
    const auto samples = static_cast<int>(scene.params.samples);
    const bool is_one_packet = by_pixels && packet_shape(program.lanes, samples).samples == samples;
    if (is_one_packet && !kernels.any_samples && !kernels.features.all()) program.samples = samples;
    return program;
}

std::size_t picture_group(const KernelChoice& kernels, int lanes) {
    if (kernels.group != 0) return kernels.group;
    return lanes == 1 ? single_group : packet_group;
}

template <typename T>
std::unique_ptr<Renderer<T>> make_cl_renderer(const FlatScene<T>& scene, const ClDevice& device,
                                              const ClOptions& options) {
    if (sizeof(T) == sizeof(double) && !device.has_double) {
        throw Error(ExitCode::device,
                    fmt::format("{} has no double precision; use --precision float or --device "
                                "threads",
                                device.name));
    }
    return std::make_unique<ClRenderer<T>>(scene, device, options);
}

template ProgramOptions picture_program(const FlatScene<float>&, const ClDevice&, const ClOptions&);
template ProgramOptions picture_program(const FlatScene<double>&, const ClDevice&,
                                        const ClOptions&);
template std::unique_ptr<Renderer<float>> make_cl_renderer(const FlatScene<float>&, const ClDevice&,
                                                           const ClOptions&);
template std::unique_ptr<Renderer<double>> make_cl_renderer(const FlatScene<double>&,
                                                            const ClDevice&, const ClOptions&);

}  // namespace rt
