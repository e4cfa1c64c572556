// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/blame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/base/version.h"
#include "host/explain/ray_tree.h"
#include "host/opencl/cl_ray_tracer.h"
#include "host/opencl/cl_tiles.h"
#include "host/opencl/render_kernels.h"
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

/// A function that is wrong by itself.
struct WrongFunction {
    const ProbeRecord* record;
    int lanes;
    std::string why;
};

/// Functions one by one.
class FunctionBlame {
   public:
    explicit FunctionBlame(const ClDevice& device)
        : device_(device), probes_(device), records_(recorded_probes()), parts_(probe_kernels) {}

    /// Fills the blame in, if a function is wrong.
    void find(Blame& blame, const std::string& folder) {
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
            if (!wrong.empty()) return tell(wrong, blame, folder);
        }
        const ProbeRecord many = many_items_record(records_);
        const std::string why =
            why_of([&] { return what_is_wrong(probes_, many, 1, "", many.count); });
        if (why.empty()) return;
        blame.verdict = "more than 2^20 work items in a launch";
        blame.text += fmt::format("wrong with {} work items: {}\n", many.count, why);
        reproduce({&many, 1, why}, blame, folder);
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

    /// The device's own arithmetic and layout, which no function is called for; else the first
    /// function that calls none of the others.
    const WrongFunction& innermost(const std::vector<WrongFunction>& wrong) const {
        const auto find = [&](const auto& fits) {
            return std::find_if(wrong.begin(), wrong.end(), fits);
        };
        auto found = find([](const WrongFunction& one) {
            constexpr const char* own[] = {"layout",      "product", "quotient",
                                           "square_root", "fused",   "shifted"};
            return std::ranges::find(own, one.record->function) != std::end(own);
        });
        if (found != wrong.end()) return *found;
        found = find([&](const WrongFunction& one) {
            const std::string& function = one.record->function;
            const auto called = parts_.reached_from("probe_" + function);
            return std::none_of(wrong.begin(), wrong.end(), [&](const WrongFunction& other) {
                return other.record->function != function &&
                       called.count(other.record->function) != 0;
            });
        });
        return found == wrong.end() ? wrong.front() : *found;
    }

    void tell(const std::vector<WrongFunction>& wrong, Blame& blame, const std::string& folder) {
        const WrongFunction& culprit = innermost(wrong);
        const std::string& function = culprit.record->function;
        blame.verdict = "the function " + function;
        blame.text += fmt::format("{} in {}, packets of {}: {}\n", function,
                                  precision_name(*culprit.record), culprit.lanes, culprit.why);
        std::vector<std::string> others;
        for (const WrongFunction& one : wrong) {
            if (one.record != culprit.record) others.push_back(one.record->function);
        }
        if (!others.empty()) {
            blame.text += fmt::format("also wrong, perhaps since they call it: {}\n",
                                      fmt::join(others, ", "));
        }
        for (const int lanes : {1, 2, 4, 8, 16}) {
            const bool is_right = why_wrong(*culprit.record, lanes).empty();
            blame.text +=
                fmt::format("packets of {:<17} {}\n", lanes, is_right ? "right" : "WRONG");
        }
        const bool helps = why_wrong(*culprit.record, culprit.lanes, without_optimizer).empty();
        blame.text += fmt::format("{:<28} {}\n", without_optimizer, helps ? "right" : "WRONG");
        if (helps) blame.verdict += ", if optimized";
        reproduce(culprit, blame, folder);
    }

    void reproduce(const WrongFunction& wrong, Blame& blame, const std::string& folder) const {
        const ProbeRecord& record = *wrong.record;
        ProgramOptions options;
        options.lanes = wrong.lanes;
        options.precision = record.is_double ? Precision::float64 : Precision::float32;
        options.entries = {false, false, false, false};
        KernelLaunch launch;
        launch.kernel = "probe_" + record.function;
        launch.options = build_options(device_, options);
        launch.numbers = record.outputs[0].holds_numbers ? precision_name(record) : "int";
        const auto lanes = static_cast<std::size_t>(wrong.lanes);
        launch.items = ((record.count + lanes - 1) / lanes + 63) / 64 * 64;
        launch.add_value(std::uint32_t{0});
        launch.add_value(record.count);
        for (const ProbeArray& input : record.inputs) launch.add("in", input.bytes);
        for (const ProbeArray& output : record.outputs) launch.add("out", output.bytes);
        blame.reproducer = folder;
        write_reproducer(folder, launch, probe_kernels, blame.text);
    }

    const ClDevice& device_;
    ProbeDevice probes_;
    const std::vector<ProbeRecord> records_;
    const SourceParts parts_;
};

/// A way to render.
struct Variant {
    std::string what;
    KernelChoice kernels;
    const char* options = "";
    std::size_t group = 0;  ///< work items; 0: as is best
};

/// Whole kernels in one precision.
template <typename T>
class PictureBlame {
   public:
    explicit PictureBlame(const ClDevice& device) : device_(device) {}

    void find(Blame& blame, const std::string& folder) {
        KernelChoice all, samples, own;
        all.features = samples.features = Features{};
        all.any_samples = samples.any_samples = true;
        all.launch = own.launch = Launch::pixel;
        samples.launch = Launch::sample;
        for (const Variant& base :
             {Variant{"all features", all}, Variant{"a sample per work item", samples},
              Variant{"the scene's features", own}}) {
            RenderCache cache;
            for (const GoldenPicture& picture : golden_pictures()) {
                const bool is_plain = picture.mode == "none" || picture.mode == "grid:2";
                if (!is_plain || picture.precision != precision_of<T>) continue;
                golden_ = picture;
                scene_ = golden_scene(picture);
                if (is_right(base, &cache)) continue;
                flat_ = flatten<T>(scene_);
                blame.text += fmt::format("no function is wrong alone, but {} is, with {}\n",
                                          picture.name(), base.what);
                vary(base, blame);
                try {
                    explain(base, blame);
                    reproduce(base, blame, folder);
                } catch (const Error& error) {
                    blame.text += fmt::format("no more is known: {}\n", error.what());
                }
                return;
            }
        }
    }

   private:
    RenderedPicture rendered(const DeviceChoice& device, const Variant& variant,
                             RenderCache* cache) const {
        const BuildExtras before = build_extras();
        build_extras().options += std::string(" ") + variant.options;
        build_extras().group = variant.group;
        try {
            RenderedPicture picture = render_golden(golden_, device, variant.kernels, cache);
            build_extras() = before;
            return picture;
        } catch (...) {
            build_extras() = before;
            throw;
        }
    }

    bool is_right(const Variant& variant, RenderCache* cache = nullptr) const {
        return why_of([&]() -> std::string {
                   const auto picture = rendered({.device = device_}, variant, cache);
                   return hash_text(picture.stats.image_hash) == golden_.hash ? "" : "wrong";
               })
            .empty();
    }

    std::vector<Variant> variants_of(const Variant& base) const {
        std::vector<Variant> variants;
        const auto add = [&](const std::string& what, const auto& change) {
            Variant& variant = variants.emplace_back(base);
            variant.what = what;
            change(variant);
        };
        for (const int lanes : {16, 8, 4, 2, 1}) {
            add(fmt::format("packets of {}", lanes), [&](auto& v) { v.kernels.lanes = lanes; });
        }
        const bool is_sampled = base.kernels.launch == Launch::sample;
        add(is_sampled ? "a pixel per work item" : "a sample per work item",
            [&](auto& v) { v.kernels.launch = is_sampled ? Launch::pixel : Launch::sample; });
        for (const FeatureName& feature : feature_names) {
            if (flat_.features.*feature.flag) continue;
            const bool is_on = base.kernels.features.*feature.flag;
            add(fmt::format("{} {}", is_on ? "without" : "with", feature.name),
                [&](auto& v) { v.kernels.features.*feature.flag = !is_on; });
        }
        add("groups of 1 work item", [](auto& v) { v.group = 1; });
        add("groups of 32 work items", [](auto& v) { v.group = 32; });
        add(without_optimizer, [](auto& v) { v.options = without_optimizer; });
        return variants;
    }

    /// Renders with one thing changed at a time, and names what makes the picture right.
    void vary(const Variant& base, Blame& blame) const {
        std::vector<std::string> helps;
        for (const Variant& variant : variants_of(base)) {
            const bool right = is_right(variant);
            blame.text += fmt::format("{:<28} {}\n", variant.what, right ? "right" : "WRONG");
            if (right) helps.push_back(variant.what);
        }
        blame.verdict = "whole kernels with " + base.what +
                        (helps.empty() ? ", whatever is changed"
                                       : fmt::format("; right with: {}", fmt::join(helps, "; ")));
    }

    /// The first pixel that differs from threads', and the first ray of its tree that does.
    void explain(const Variant& base, Blame& blame) const {
        const Picture right = rendered(threads_choice(), {}, nullptr).picture;
        const Picture got = rendered({.device = device_}, base, nullptr).picture;
        const auto [a, b] =
            std::mismatch(got.pixels.begin(), got.pixels.end(), right.pixels.begin());
        if (a == got.pixels.end()) return;
        const int pixel = static_cast<int>((a - got.pixels.begin()) / 3);
        const int x = pixel % got.width, y = pixel / got.width;
        blame.text += fmt::format(
            "the first pixel that differs: {},{} of {}x{}: {:a} instead of "
            "{:a}\n",
            x, y, got.width, got.height, *a, *b);
        blame.text += first_wrong_ray(explain_pixel(flatten<double>(scene_), x, y).events);
    }

    /// Traces the rays of a pixel one by one on both sides.
    std::string first_wrong_ray(const std::vector<PathEvent>& events) const {
        std::vector<typename Flat<T>::RayQuery> queries;
        std::vector<std::string> names;
        std::string from = "the eye";
        std::size_t named = 0;  // a hit comes after the shadow rays that start there
        for (const PathEvent& event : events) {
            if (event.what == RT_EVENT_HIT) {
                from = primitive_name(event.index);
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
            names.push_back(is_shadow ? fmt::format("shadow ray to light {}", event.index + 1)
                            : event.what == RT_EVENT_SAMPLE ? "eye ray"
                            : event.what == RT_EVENT_MIRROR ? "mirror ray from " + from
                                                            : "refracted ray from " + from);
        }
        std::vector<typename Flat<T>::RayAnswer> got(queries.size()), right(queries.size());
        make_cl_ray_tracer<T>(flat_, device_, {})(queries, got);
        make_threads_ray_tracer<T>(flat_, {})(queries, right);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const auto &a = got[i], &b = right[i];
            if (a.is_blocked != b.is_blocked) {
                return names[i] +
                       (a.is_blocked != 0 ? ": hits, should miss\n" : ": misses, should hit\n");
            }
            if (a.prim == b.prim && (b.prim < 0 || a.t == b.t)) continue;
            return fmt::format("{}: hits {} at {:a}, should hit {} at {:a}\n", names[i],
                               primitive_name(static_cast<long>(a.prim)), a.t,
                               primitive_name(static_cast<long>(b.prim)), b.t);
        }
        return "each ray of its tree is right alone: the fault is in what is made of them\n";
    }

    std::string primitive_name(long prim) const {
        if (prim < 0) return "nothing";
        if (!flat_.order.empty()) {
            prim = static_cast<long>(flat_.order[static_cast<std::size_t>(prim)]);
        }
        const auto spheres = static_cast<long>(flat_.params.sphere_count);
        const auto cones = static_cast<long>(flat_.params.cone_count);
        if (prim < spheres) return fmt::format("sphere {}", prim + 1);
        if (prim < spheres + cones) return fmt::format("cone {}", prim - spheres + 1);
        return fmt::format("triangle {}", prim - spheres - cones + 1);
    }

    /// The whole picture in one launch. Samples are compared where a pixel has but one.
    void reproduce(const Variant& base, Blame& blame, const std::string& folder) const {
        const bool is_sampled = base.kernels.launch == Launch::sample;
        const int samples = static_cast<int>(flat_.params.samples);
        if (is_sampled && samples != 1) return;
        const Rect whole{0, 0, scene_.width, scene_.height};
        Film<T> right(whole.width, whole.height);
        static const StopFlag never_stopped{0};
        TileQueue queue({whole}, never_stopped);
        make_threads_renderer<T>(flat_, {})->render(queue, whole, right);
        ProgramOptions options;
        options.precision = precision_of<T>;
        options.lanes = is_sampled ? 1 : packet_lanes<T>(base.kernels.lanes, device_);
        options.features = either_of(flat_.features, base.kernels.features);
        options.entries = {!is_sampled, is_sampled, false, false};
        KernelLaunch launch;
        launch.kernel = is_sampled ? "render_samples" : "render_pixels";
        launch.options = build_options(device_, options);
        launch.numbers = to_string(precision_of<T>);
        // At most a packet for each pixel.
        launch.items = static_cast<std::size_t>((whole.pixels() * samples + 63) / 64 * 64);
        launch.add("out", std::as_bytes(std::span(right.rgb)));
        launch.add("scratch",
                   std::vector<std::byte>(launch.items * sizeof(typename Flat<T>::RayCounts)));
#define RT_LAUNCH_ARRAY(type, name, what) launch.add("in", std::as_bytes(std::span(flat_.name)));
        RT_SCENE_ARRAYS(RT_LAUNCH_ARRAY)
#undef RT_LAUNCH_ARRAY
        launch.add_value(flat_.params);
        launch.add_value(flat_tile<T>(whole, whole));
        blame.reproducer = folder;
        write_reproducer(folder, launch, render_kernels, blame.text);
    }

    const ClDevice& device_;
    GoldenPicture golden_;
    Scene scene_;
    FlatScene<T> flat_;
};

}  // namespace

Blame blame_device(const ClDevice& device, const std::string& folder) {
    Blame blame;
    blame.text = fmt::format("{} ({}, driver {}), mirrorball {} ({})\n", device.name,
                             device.platform, device.driver, version, git_revision);
    FunctionBlame(device).find(blame, folder);
    if (blame.verdict.empty()) PictureBlame<float>(device).find(blame, folder);
    if (blame.verdict.empty() && device.has_double) {
        PictureBlame<double>(device).find(blame, folder);
    }
    return blame;
}

}  // namespace rt
