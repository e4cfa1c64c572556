// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/version.h"
#include "host/explain/ray_tree.h"
#include "host/opencl/cl_options.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/cl_tiles.h"
#include "host/picture/crew_members.h"
#include "host/process/worker.h"
#include "host/render/packet_shape.h"
#include "host/render/threads_renderer.h"
#include "host/selftest/reproducer.h"
#include "host/selftest/selftest.h"

namespace rt {

namespace {

constexpr const char* without_optimizer = "-cl-opt-disable";

/// The result of a check: what is wrong, errors included.
std::string why_of(const std::function<std::string()>& check) {
    Checks checks({}, {});
    checks.run("blame", check);
    return checks.list().empty() ? "stopped" : checks.list().front().why;
}

/// A function that is wrong on its own.
struct WrongFunction {
    const ProbeRecord* record;
    int lanes;
    std::string why;
};

/// Probes of the device's own arithmetic and layout, for which the kernels call no function.
constexpr const char* own_probes[] = {"layout",      "product", "quotient",
                                      "square_root", "fused",   "shifted"};

/// Functions one by one.
class FunctionBlame {
   public:
    /// `folder`: for the reproducer.
    FunctionBlame(const ClDevice& device, const std::string& folder, Blame& blame)
        : device_(device), folder_(folder), blame_(blame), probes_(device) {}

    /// Fills the blame in, if a function is wrong.
    void find() {
        const int float_lanes = packet_lanes<float>(0, device_);
        const int double_lanes = packet_lanes<double>(0, device_);
        struct Step {
            bool is_double, of_scenes;
            int lanes;
        };
        for (const auto& [is_double, of_scenes, lanes] :
             {Step{false, false, float_lanes}, Step{false, false, 1}, Step{false, false, 16},
              Step{true, false, double_lanes}, Step{false, true, float_lanes},
              Step{true, true, double_lanes}}) {
            if (is_double && !device_.has_double) continue;
            const auto wrong = wrong_with(lanes, is_double, of_scenes);
            if (!wrong.empty()) return tell(wrong);
        }
        const ProbeRecord many = many_items_record(records_);
        const std::string why =
            why_of([&] { return what_is_wrong(probes_, many, 1, "", many.count); });
        if (why.empty()) return;
        blame_.verdict = "more than 2^20 work items in a launch";
        blame_.text += fmt::format("wrong with {} work items: {}\n", many.count, why);
        reproduce({&many, 1, why});
    }

   private:
    std::string why_wrong(const ProbeRecord& record, int lanes, const char* options = "") {
        return why_of([&] { return what_is_wrong(probes_, record, lanes, options); });
    }

    std::vector<WrongFunction> wrong_with(int lanes, bool is_double, bool of_scenes) {
        std::vector<WrongFunction> wrong;
        for (const ProbeRecord& record : records_) {
            const bool has_scene = record.inputs.size() >= scene_inputs;
            if (record.is_double != is_double || has_scene != of_scenes) continue;
            if (!wrong.empty() && wrong.back().record->function == record.function) continue;
            std::string why = why_wrong(record, lanes);
            if (!why.empty()) wrong.push_back({&record, lanes, std::move(why)});
        }
        return wrong;
    }

    /// The one that calls none of the others: what is called is defined before.
    const WrongFunction& innermost(const std::vector<WrongFunction>& wrong) const {
        return *std::ranges::min_element(wrong, {}, [&](const WrongFunction& one) {
            const std::string& function = one.record->function;
            const bool is_own = std::ranges::find(own_probes, function) != std::end(own_probes);
            return is_own ? 0 : 1 + parts_.place_of(function);
        });
    }

    void tell(const std::vector<WrongFunction>& wrong) {
        const WrongFunction& culprit = innermost(wrong);
        const std::string& function = culprit.record->function;
        blame_.verdict = "the function " + function;
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
        ProgramOptions options;
        options.lanes = wrong.lanes;
        KernelLaunch launch;
        launch.kernel = "probe_" + record.function;
        launch.options = build_options(device_, probe_program(options, record));
        launch.numbers = record.outputs[0].holds_numbers ? precision_name(record) : "int";
        const auto lanes = static_cast<std::size_t>(wrong.lanes);
        launch.items = (record.count + lanes - 1) / lanes;
        launch.add_value(std::uint32_t{0});
        launch.add_value(record.count);
        for (const ProbeArray& input : record.inputs) launch.add("in", input.bytes);
        for (const ProbeArray& output : record.outputs) launch.add("out", output.bytes);
        blame_.reproducer = folder_;
        write_reproducer(folder_, launch, probe_kernels, blame_.text);
    }

    const ClDevice& device_;
    const std::string& folder_;
    Blame& blame_;
    ProbeDevice probes_;
    const std::vector<ProbeRecord> records_ = recorded_probes();
    const SourceParts parts_{probe_kernels};
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
        all.features = samples.features = Features{};
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
                if (!is_plain || picture.precision != precision_of<T>) continue;
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
        try {
            const Film<T> right = rendered(*make_threads_renderer<T>(flat_, {}));
            explain(right);
            reproduce(right);
        } catch (const Error& error) {
            blame_.text += fmt::format("no more is known: {}\n", error.what());
        }
    }

    bool is_right(const KernelChoice& kernels, RenderCache* cache = nullptr) const {
        return why_of([&]() -> std::string {
                   const auto picture = render_golden(golden_, {.device = device_}, kernels, cache);
                   return hash_text(picture.stats.image_hash) == golden_.hash ? "" : "wrong";
               })
            .empty();
    }

    Rect whole() const { return {0, 0, scene_.width, scene_.height}; }

    ClOptions options() const { return {.kernels = base_.kernels}; }

    Film<T> rendered(Renderer<T>& renderer) const {
        Film<T> film(scene_.width, scene_.height);
        static const StopFlag never_stopped{0};
        TileQueue queue({whole()}, never_stopped);
        renderer.render(queue, whole(), film);
        return film;
    }

    std::vector<Variant> variants() const {
        std::vector<Variant> all;
        const auto add = [&](const std::string& what, const auto& change) {
            Variant& variant = all.emplace_back(base_);
            variant.what = what;
            change(variant);
        };
        for (const int lanes : {16, 8, 4, 2, 1}) {
            add(fmt::format("packets of {}", lanes), [&](auto& v) { v.kernels.lanes = lanes; });
        }
        const bool is_sampled = base_.kernels.launch == Launch::sample;
        add(is_sampled ? "a pixel per work item" : "a sample per work item",
            [&](auto& v) { v.kernels.launch = is_sampled ? Launch::pixel : Launch::sample; });
        for (const FeatureName& feature : feature_names) {
            if (flat_.features.*feature.flag) continue;
            const bool is_on = base_.kernels.features.*feature.flag;
            add(fmt::format("{} {}", is_on ? "without" : "with", feature.name),
                [&](auto& v) { v.kernels.features.*feature.flag = !is_on; });
        }
        add("groups of 1 work item", [](auto& v) { v.kernels.group = 1; });
        add("groups of 32 work items", [](auto& v) { v.kernels.group = 32; });
        add(without_optimizer, [](auto& v) { v.kernels.cl_options = without_optimizer; });
        return all;
    }

    /// Renders with one thing changed at a time, and names what makes the picture right.
    void vary() {
        std::vector<std::string> helps;
        for (const Variant& variant : variants()) {
            const bool right = is_right(variant.kernels);
            blame_.text += fmt::format("{:<28} {}\n", variant.what, right ? "right" : "WRONG");
            if (right) helps.push_back(variant.what);
        }
        blame_.verdict = "whole kernels with " + base_.what +
                         (helps.empty() ? ", whatever is changed"
                                        : fmt::format("; right with: {}", fmt::join(helps, "; ")));
    }

    /// The first pixel that differs from threads', and the first ray of its tree that does.
    void explain(const Film<T>& right) {
        const Film<T> got = rendered(*make_cl_renderer<T>(flat_, device_, options()));
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
        return "each ray of its tree is right alone: the fault is in what is made of them\n";
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
        KernelLaunch launch;
        launch.kernel = is_sampled ? "render_samples" : "render_pixels";
        launch.options = build_options(device_, program);
        launch.numbers = to_string(precision_of<T>);
        launch.group = picture_group(base_.kernels, program.lanes);
        // At most a packet for each pixel.
        launch.items = static_cast<std::size_t>(whole().pixels() * samples);
        launch.add("out", std::as_bytes(std::span(right.rgb)));
        const std::size_t counts = launch.whole_groups() * sizeof(typename Flat<T>::RayCounts);
        launch.add("scratch", std::vector<std::byte>(counts));
#define RT_LAUNCH_ARRAY(type, name, what) launch.add("in", std::as_bytes(std::span(flat_.name)));
        RT_SCENE_ARRAYS(RT_LAUNCH_ARRAY)
#undef RT_LAUNCH_ARRAY
        launch.add_value(flat_.params);
        launch.add_value(flat_tile<T>(whole(), whole()));
        blame_.reproducer = folder_;
        write_reproducer(folder_, launch, render_kernels, blame_.text);
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
    FunctionBlame(device, folder, blame).find();
    if (blame.verdict.empty()) PictureBlame<float>(device, folder, blame).find();
    if (blame.verdict.empty() && device.has_double) {
        PictureBlame<double>(device, folder, blame).find();
    }
    return blame;
}

}  // namespace rt
