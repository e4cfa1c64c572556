// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/version.h"
#include "host/explain/ray_tree.h"
#include "host/image/output_file.h"
#include "host/opencl/cl_renderer.h"
#include "host/picture/crew.h"
#include "host/process/worker.h"
#include "host/render/threads_renderer.h"
#include "host/selftest/selftest.h"

namespace rt {

extern const char* const reproduce_program;  // contrib/reproduce/reproduce.c, embedded by CMake

namespace {

constexpr const char* without_optimizer = "-cl-opt-disable";

/// The result of a check: what is wrong, errors included.
std::string why_of(const std::string& name, const std::function<std::string()>& check) {
    Checks checks({}, {});
    checks.run(name, check);
    return checks.list().empty() ? "stopped" : checks.list().front().why;
}

/// Writes a kernel launch as contrib/reproduce/reproduce.c makes it to a folder. Throws Error
/// (output).
class Reproducer {
   public:
    /// `numbers`: of the results; see reproduce.c.
    Reproducer(std::string folder, const std::string& kernel, const std::string& options,
               const char* numbers, std::size_t items, std::size_t group)
        : folder_(std::move(folder)), global_((items + group - 1) / group * group) {
        create_output_folder(folder_);
        launch_ = fmt::format("kernel {}\noptions {}\nnumbers {}\nglobal {}\nlocal {}\n", kernel,
                              options, numbers, global_, group);
    }

    /// An argument of one of its kinds.
    void add(const char* kind, std::span<const std::byte> bytes) {
        const std::string file = fmt::format("argument{}.bin", count_++);
        launch_ += fmt::format("{} {}\n", kind, file);
        write_file_atomically(folder_ + "/" + file, bytes);
    }
    template <typename T>
    void add_value(const T& x) {
        add("value", std::as_bytes(std::span(&x, 1)));
    }
    void add_scratch(std::size_t bytes_per_item) {
        launch_ += fmt::format("scratch {}\n", global_ * bytes_per_item);
    }

    void finish(std::string_view source, std::string_view readme) const {
        for (const auto& [file, text] :
             {std::pair<const char*, std::string_view>{"launch.txt", launch_},
              {"kernel.cl", source},
              {"reproduce.c", reproduce_program},
              {"README", readme}}) {
            write_file_atomically(folder_ + "/" + file, std::as_bytes(std::span(text)));
        }
    }

   private:
    const std::string folder_;
    const std::size_t global_;
    std::string launch_;
    int count_ = 0;
};

/// A function that is wrong on its own.
struct WrongFunction {
    const ProbeRecord* record;
    int lanes;
    std::string why;
};

/// Probes of the device's own arithmetic, for which the kernels call no function.
constexpr const char* own_probes[] = {"product", "quotient", "square_root", "fused", "shifted"};

/// Functions one by one.
class FunctionBlame {
   public:
    /// `folder`: for the reproducer.
    FunctionBlame(const ClDevice& device, const std::string& folder, Blame& blame)
        : device_(device), folder_(folder), blame_(blame), probes_(device) {}

    /// Fills the blame in, if a function is wrong. Those that take scenes, and many items, are
    /// tried only if all others are right; after a wrong one, others in its precision and packets.
    void find() {
        const auto stage = [](const ProbeRecord& record) {
            return record.in_one_launch ? 2 : record.has_scene() ? 1 : 0;
        };
        std::vector<WrongFunction> wrong;
        for (const FunctionCheck& check : function_checks(records_, device_, false)) {
            for (const ProbeRecord& record : check.records) {
                if (!wrong.empty()) {
                    const WrongFunction& first = wrong.front();
                    const bool is_like_it = check.lanes == first.lanes &&
                                            record.is_double == first.record->is_double &&
                                            stage(record) == stage(*first.record);
                    const bool is_known = wrong.back().record->function == record.function;
                    if (is_known || !is_like_it) continue;
                }
                std::string why = why_wrong(record, check.lanes);
                if (!why.empty()) wrong.push_back({&record, check.lanes, std::move(why)});
            }
        }
        if (!wrong.empty()) tell(wrong);
    }

   private:
    std::string why_wrong(const ProbeRecord& record, int lanes, const char* options = "") {
        return why_of("blame: " + record.function,
                      [&] { return what_is_wrong(probes_, record, lanes, options); });
    }

    /// The one that calls none of the others: what is called is defined before.
    static const WrongFunction& innermost(const std::vector<WrongFunction>& wrong) {
        return *std::ranges::min_element(wrong, {}, [](const WrongFunction& one) {
            const std::string& function = one.record->function;
            const bool is_own = std::ranges::find(own_probes, function) != std::end(own_probes);
            return is_own ? 0 : std::string_view(probe_kernels).find(" " + function + "(");
        });
    }

    void tell(const std::vector<WrongFunction>& wrong) {
        const WrongFunction& culprit = innermost(wrong);
        const std::string& function = culprit.record->function;
        blame_.verdict = culprit.record->in_one_launch ? "more than 2^20 work items in a launch"
                                                       : "the function " + function;
        blame_.text += fmt::format("{} in {}, packets of {}: {}\n", function,
                                   precision_name(*culprit.record), culprit.lanes, culprit.why);
        std::vector<std::string> others;
        for (const WrongFunction& one : wrong) {
            if (one.record != culprit.record) others.push_back(one.record->function);
        }
        if (!others.empty()) {
            blame_.text += fmt::format("also wrong, perhaps since they call it: {}\n",
                                       fmt::join(others, ", "));
        }
        for (const int lanes : {1, 2, 4, 8, 16}) {
            const bool is_right = why_wrong(*culprit.record, lanes).empty();
            blame_.text +=
                fmt::format("packets of {:<17} {}\n", lanes, is_right ? "right" : "WRONG");
        }
        const bool helps = why_wrong(*culprit.record, culprit.lanes, without_optimizer).empty();
        blame_.text += fmt::format("{:<28} {}\n", without_optimizer, helps ? "right" : "WRONG");
        if (helps) blame_.verdict += ", if optimized";
        reproduce(culprit);
    }

    void reproduce(const WrongFunction& wrong) const {
        const ProbeRecord& record = *wrong.record;
        ProgramOptions program;
        program.lanes = wrong.lanes;
        const auto lanes = static_cast<std::size_t>(wrong.lanes);
        Reproducer launch(folder_, "probe_" + record.function,
                          build_options(device_, probe_program(program, record)),
                          record.outputs[0].holds_numbers ? precision_name(record) : "int",
                          (record.count + lanes - 1) / lanes, 64);
        launch.add_value(std::uint32_t{0});
        launch.add_value(record.count);
        for (const ProbeArray& input : record.inputs) launch.add("in", input.bytes);
        for (const ProbeArray& output : record.outputs) launch.add("out", output.bytes);
        blame_.reproducer = folder_;
        launch.finish(probe_kernels, blame_.text);
    }

    const ClDevice& device_;
    const std::string& folder_;
    Blame& blame_;
    ProbeDevice probes_;
    const std::vector<ProbeRecord> records_ = checked_probes();
};

/// A way to render.
struct Variant {
    std::string what;
    KernelChoice kernels;
};

/// Whole kernels in one precision.
template <typename T>
class PictureBlame {
   public:
    /// `folder`: for the reproducer.
    PictureBlame(const ClDevice& device, const std::string& folder, Blame& blame)
        : device_(device), folder_(folder), blame_(blame) {}

    /// Fills the blame in, if a picture is wrong.
    void find() {
        KernelChoice all, samples, own;
        all.features = samples.features = every_feature;
        all.any_samples = samples.any_samples = true;
        all.launch = own.launch = Launch::pixel;
        samples.launch = Launch::sample;
        for (const Variant& base :
             {Variant{"all features", all}, Variant{"a sample per work item", samples},
              Variant{"the scene's features", own}}) {
            RenderCache cache;
            base_ = base;
            for (const GoldenPicture& picture : golden_pictures()) {
                const bool is_plain = picture.mode == "none" || picture.mode == "grid:2";
                const bool is_own = !base.kernels.any_samples;  // the others take long to compile
                if (picture.precision != precision_of<T> || (!is_plain && !is_own)) continue;
                golden_ = picture;
                if (!is_right(base.kernels, &cache)) return tell();
            }
        }
    }

   private:
    void tell() {
        scene_ = golden_scene(golden_);
        flat_ = flatten<T>(scene_);
        blame_.text += fmt::format("no function is wrong alone, but {} is, with {}\n",
                                   golden_.name(), base_.what);
        vary();
        if (!scene_.aa.fixed_samples()) return;  // rays depend on other pixels' there
        const DriverTask task(device_.name);     // vary's checks have ended the last one
        try {
            const auto renderer = make_threads_renderer<T>(flat_, {});
            const Film<T> right = render_region(*renderer, whole()).first;
            explain(right);
            reproduce(right);
        } catch (const Error& error) {
            blame_.text += fmt::format("no more is known: {}\n", error.what());
        }
    }

    bool is_right(const KernelChoice& kernels, RenderCache* cache = nullptr) const {
        return why_of("blame: " + golden_.name(),
                      [&]() -> std::string {
                          const auto picture =
                              render_golden(golden_, {.device = device_}, kernels, cache);
                          return hash_text(picture.stats.image_hash) == golden_.hash ? "" : "wrong";
                      })
            .empty();
    }

    Rect whole() const { return {0, 0, scene_.width, scene_.height}; }

    ClOptions options() const { return {.kernels = base_.kernels}; }

    /// Renders with one thing changed at a time, and names what makes the picture right.
    void vary() {
        std::vector<std::string> helps;
        const auto vary_by = [&](const std::string& what, const auto& change) {
            KernelChoice kernels = base_.kernels;
            change(kernels);
            const bool right = is_right(kernels);
            blame_.text += fmt::format("{:<28} {}\n", what, right ? "right" : "WRONG");
            if (right) helps.push_back(what);
        };
        for (const int lanes : {16, 8, 4, 2, 1}) {
            vary_by(fmt::format("packets of {}", lanes), [&](auto& k) { k.lanes = lanes; });
        }
        const bool is_sampled = base_.kernels.launch == Launch::sample;
        vary_by(is_sampled ? "a pixel per work item" : "a sample per work item",
                [&](auto& k) { k.launch = is_sampled ? Launch::pixel : Launch::sample; });
        for (std::size_t i = 0; i < flat_.features.size(); ++i) {
            if (flat_.features[i]) continue;
            const bool is_on = base_.kernels.features[i];
            vary_by(fmt::format("{} {}", is_on ? "without" : "with", feature_names[i]),
                    [&](auto& k) { k.features.flip(i); });
        }
        vary_by("groups of 1 work item", [](auto& k) { k.group = 1; });
        vary_by("groups of 32 work items", [](auto& k) { k.group = 32; });
        vary_by(without_optimizer, [](auto& k) { k.cl_options = without_optimizer; });
        blame_.verdict = "whole kernels with " + base_.what +
                         (helps.empty() ? ", whatever is changed"
                                        : fmt::format("; right with: {}", fmt::join(helps, "; ")));
    }

    /// The first pixel that differs from threads', and the first ray of its tree that does.
    void explain(const Film<T>& right) {
        const auto renderer = make_cl_renderer<T>(flat_, device_, options());
        const Film<T> got = render_region(*renderer, whole()).first;
        const auto [a, b] = std::ranges::mismatch(got.rgb, right.rgb);
        if (a == got.rgb.end()) return;
        const int pixel = static_cast<int>((a - got.rgb.begin()) / 3);
        const int x = pixel % got.width, y = pixel / got.width;
        blame_.text +=
            fmt::format("the first pixel that differs: {},{} of {}x{}: {:a} instead of {:a}\n", x,
                        y, got.width, got.height, *a, *b);
        const FlatScene<double> in_double = flatten<double>(scene_);
        blame_.text += first_wrong_ray(in_double, explain_pixel(in_double, x, y).events);
    }

    /// Traces the rays of a pixel, explained in double, one by one on both sides.
    std::string first_wrong_ray(const FlatScene<double>& explained,
                                const std::vector<PathEvent>& events) const {
        std::vector<typename Flat<T>::RayQuery> queries;
        std::vector<std::string> names;
        const std::vector<std::size_t> lights = shining_lights(scene_);
        std::string from = "the eye";
        std::size_t named = 0;  // a hit comes after the shadow rays that start there
        for (const PathEvent& event : events) {
            if (event.what == RT_EVENT_HIT) {
                from = name_of(explained, event.index);
                for (; named < names.size(); ++named) {
                    if (names[named].starts_with("shadow")) names[named] += " from " + from;
                }
            }
            const bool is_shadow = event.what == RT_EVENT_SHADOW;
            if (event.what > RT_EVENT_SHADOW || event.what == RT_EVENT_MISS) continue;
            auto& query = queries.emplace_back();
            query = {};
            query.origin = {T(event.point[0]), T(event.point[1]), T(event.point[2])};
            query.dir = {T(event.normal[0]), T(event.normal[1]), T(event.normal[2])};
            query.t_max = is_shadow ? T(event.distance) : std::numeric_limits<T>::infinity();
            query.from = Flat<T>::none;
            const auto at_light = static_cast<std::size_t>(is_shadow ? event.index : 0);
            names.push_back(is_shadow ? fmt::format("shadow ray to light {}", lights[at_light] + 1)
                            : event.what == RT_EVENT_SAMPLE ? "eye ray"
                            : event.what == RT_EVENT_MIRROR ? "mirror ray from " + from
                                                            : "refracted ray from " + from);
        }
        std::vector<typename Flat<T>::RayAnswer> got(queries.size()), right(queries.size());
        make_cl_ray_tracer<T>(flat_, device_, options())(queries, got);
        make_threads_ray_tracer<T>(flat_, {})(queries, right);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const auto &a = got[i], &b = right[i];
            if (a.is_blocked != b.is_blocked) {
                return names[i] +
                       (a.is_blocked != 0 ? ": hits, should miss\n" : ": misses, should hit\n");
            }
            if (a.prim == b.prim && (b.prim < 0 || a.t == b.t)) continue;
            return fmt::format("{}: hits {} at {:a}, should hit {} at {:a}\n", names[i],
                               name_of(flat_, a.prim), a.t, name_of(flat_, b.prim), b.t);
        }
        return "each ray of its tree is right alone\n";
    }

    template <typename F>
    std::string name_of(const FlatScene<F>& flat, std::int64_t prim) const {
        if (prim < 0) return "nothing";
        return object_of(scene_, TriangleList(scene_), number_in_scene(flat, prim));
    }

    /// The whole picture in one launch. Samples are compared where a pixel has but one.
    void reproduce(const Film<T>& right) const {
        const bool is_sampled = base_.kernels.launch == Launch::sample;
        const std::int64_t samples = flat_.params.samples;
        if (is_sampled && samples != 1) return;
        const ProgramOptions program = picture_program(flat_, device_, options());
        // At most a packet for each pixel.
        Reproducer launch(folder_, is_sampled ? "render_samples" : "render_pixels",
                          build_options(device_, program), to_string(precision_of<T>),
                          static_cast<std::size_t>(whole().pixels() * samples),
                          picture_group(base_.kernels, program.lanes));
        launch.add("out", std::as_bytes(std::span(right.rgb)));
        launch.add_scratch(sizeof(typename Flat<T>::RayCounts));
#define RT_LAUNCH_ARRAY(type, name, what) launch.add("in", std::as_bytes(std::span(flat_.name)));
        RT_SCENE_ARRAYS(RT_LAUNCH_ARRAY)
#undef RT_LAUNCH_ARRAY
        launch.add_value(flat_.params);
        launch.add_value(flat_tile<T>(whole(), whole()));
        blame_.reproducer = folder_;
        launch.finish(render_kernels, blame_.text);
    }

    const ClDevice& device_;
    const std::string& folder_;
    Blame& blame_;
    Variant base_;
    GoldenPicture golden_;
    Scene scene_;
    FlatScene<T> flat_;
};

}  // namespace

Blame blame_device(const ClDevice& device, const std::string& folder) {
    Blame blame;
    blame.text = fmt::format("{} ({}, driver {}), mirrorball {} ({})\n", device.name,
                             device.platform, device.driver, version, git_revision);
    print_note("checking functions");
    FunctionBlame(device, folder, blame).find();
    if (blame.verdict.empty()) {
        print_note("checking pictures");
        PictureBlame<float>(device, folder, blame).find();
    }
    if (blame.verdict.empty() && device.has_double) {
        PictureBlame<double>(device, folder, blame).find();
    }
    return blame;
}

}  // namespace rt
