// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/flat_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "host/base/error.h"
#include "host/base/memory.h"
#include "host/base/parallel.h"
#include "host/flatten/casters.h"
#include "host/flatten/flat_shapes.h"
#include "host/flatten/view_frame.h"

namespace rt {

namespace {

/// Primitives that a thread processes at a time.
constexpr std::size_t run_length = 1 << 13;

/// One flattening: the state its steps share.
template <typename T>
class Flattener {
   public:
    using Index = typename Flat<T>::Index;
    using Params = typename Flat<T>::LaunchParams;

    Flattener(const Scene& scene, const FlattenOptions& options)
        : scene_(scene), options_(options), triangles_(scene) {
        if (options_.threads == 0) options_.threads = available_cores();
        check_limits();
        view_ = make_view_frame(scene, triangles_, options_.threads);
        material_use_ = material_use(scene);
        check_ray_tree();
    }

    FlatScene<T> run() {
        flat_.params = flatten_params<T>(view_, scene_);
        const Kind spheres{flat_.params.sphere_root, flat_.stats.spheres};
        spheres_order_ = flatten_kind(spheres, scene_.spheres, flatten_sphere<T>, flat_.spheres);
        const Kind cones{flat_.params.cone_root, flat_.stats.cones};
        cones_order_ = flatten_kind(cones, scene_.cones, flatten_cone<T>, flat_.cones);
        flatten_triangles();
        for (const auto& material : scene_.materials) {
            flat_.materials.push_back(flatten_material<T>(material));
        }
        flat_.params.eye_on_surface = eye_is_on_surface() ? 1 : 0;  // before lights are noted
        flatten_lights();
        note_touched_lights();
        flat_.params.sphere_count = static_cast<Index>(flat_.spheres.size());
        flat_.params.cone_count = static_cast<Index>(flat_.cones.size());
        flat_.params.triangle_count = static_cast<Index>(flat_.triangles.size());
        flat_.params.light_count = static_cast<Index>(flat_.lights.size());
        number_primitives();
        set_features();
        return std::move(flat_);
    }

   private:
    /// For one kind, the number of each primitive in the scene; empty if the order was kept.
    using Order = std::vector<Index>;

    /// One kind of primitive.
    struct Kind {
        Index& root;
        KindStats& stats;
    };

    /// Primitives and nodes (fewer than two a primitive) are numbered in a 32-bit Index.
    void check_limits() const {
        const std::uint64_t limit = (std::uint64_t{1} << 30) - 8;
        const std::uint64_t count = scene_.spheres.size() + scene_.cones.size() + triangles_.size();
        if (count > limit || scene_.lights.size() > limit) {
            throw Error(ExitCode::limit,
                        fmt::format("{} primitives and {} lights; at most {} of each can be "
                                    "rendered",
                                    count, scene_.lights.size(), limit));
        }
        constexpr std::uint64_t bytes_each = sizeof(typename Flat<T>::Triangle) +
                                             2 * sizeof(typename Flat<T>::BvhNode) + sizeof(Index);
        if (count > run_length) {
            check_memory(count * bytes_each, fmt::format("flattening {} primitives", count),
                         "use a smaller scene");
        }
    }

    /// Where light is both reflected and transmitted one of the two rays must wait.
    void check_ray_tree() const {
        if (scene_.max_bounces <= f32::RT_TREE_STACK || !material_use_.splits) return;
        throw Error(
            ExitCode::limit,
            fmt::format("max_bounces is {}, but at most {} where a material both mirrors "
                        "and transmits; use --max-bounces {} or less, or make the "
                        "material's mirror or transmission 0",
                        scene_.max_bounces, int{f32::RT_TREE_STACK}, int{f32::RT_TREE_STACK}));
    }

    template <typename Work>
    void for_each(std::size_t count, const Work& work) const {
        for_each_run(count, run_length, options_.threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) work(i);
        });
    }

    /// Adds the hierarchy over a kind's `count` primitives, with the boxes box(i), if there are
    /// enough.
    template <typename Box>
    Order add_hierarchy(const Kind& kind, std::size_t count, const Box& box) {
        kind.stats.count = count;
        std::size_t crossover = bvh_crossover;
        if (options_.hierarchies.has_value()) crossover = *options_.hierarchies ? 2 : count + 1;
        if (count < crossover) return {};
        const Stopwatch watch;
        Order order(count);
        HugeVector<BvhBox<T>> boxes(count);
        for_each(count, [&](std::size_t i) {
            boxes[i] = box(i);
            boxes[i].first = static_cast<Index>(i);
        });
        kind.root = build_bvh<T>(boxes, options_.threads, flat_.nodes);
        for_each(count, [&](std::size_t i) { order[i] = boxes[i].first; });
        kind.stats.hierarchy = shape_of<T>(flat_.nodes, kind.root);
        flat_.stats.bvh_seconds += watch.seconds();
        return order;
    }

    template <typename Primitive>
    void reorder(std::vector<Primitive>& primitives, const Order& order) const {
        if (order.empty()) return;
        std::vector<Primitive> ordered(primitives.size());
        for_each(primitives.size(), [&](std::size_t i) {
            ordered[i] = primitives[static_cast<std::size_t>(order[i])];
        });
        primitives = std::move(ordered);
    }

    bool eye_is_on_surface() const {
        if (!view_.is_perspective) return false;
        const auto touches = [](const auto& shape) { return shape.touches != 0; };
        return eye_is_in_plane_ || std::ranges::any_of(flat_.spheres, touches) ||
               std::ranges::any_of(flat_.cones, touches);
    }

    /// Flattens one kind of primitive, then puts it into the order of its hierarchy's leaves.
    template <typename Listing, typename Primitive>
    Order flatten_kind(const Kind& kind, const std::vector<Listing>& listing,
                       Primitive (*flatten_one)(const ViewFrame&, const Listing&),
                       std::vector<Primitive>& primitives) {
        primitives.resize(listing.size());
        for_each(primitives.size(),
                 [&](std::size_t i) { primitives[i] = flatten_one(view_, listing[i]); });
        const Order order = add_hierarchy(kind, primitives.size(),
                                          [&](std::size_t i) { return box_of<T>(primitives[i]); });
        reorder(primitives, order);
        return order;
    }

    /// The boxes come first, from vertices rounded just for them, so that triangles can be made in
    /// leaf order: memory never holds them twice, nor along with the boxes.
    void flatten_triangles() {
        const auto count = static_cast<std::size_t>(triangles_.size());
        const Kind kind{flat_.params.triangle_root, flat_.stats.triangles};
        triangles_order_ = add_hierarchy(kind, count, [&](std::size_t i) {
            const TriangleList::Corners corners = triangles_.corners(i);
            return box_of<T>(pack_position<T>(view_, corners[0]),
                             pack_position<T>(view_, corners[1]),
                             pack_position<T>(view_, corners[2]));
        });
        flat_.triangles.resize(count);
        const std::vector<std::size_t> smooth = smooth_before_runs(count);
        flat_.vertex_normals.resize(smooth.back());
        for_each_run(count, run_length, options_.threads, [&](std::size_t first, std::size_t last) {
            std::size_t next_smooth = smooth[first / run_length];
            for (std::size_t i = first; i < last; ++i) {
                const std::size_t number = triangle_number(i);
                flat_.triangles[i] = flatten_triangle<T>(view_, triangles_.corners(number),
                                                         triangles_.material(number));
                if (flat_.triangles[i].plane == T(0)) eye_is_in_plane_ = true;
                const auto normals = triangles_.normals(number);
                if (!normals) continue;
                flat_.triangles[i].smooth = static_cast<Index>(next_smooth);
                flat_.vertex_normals[next_smooth++] = flatten_normals<T>(*normals);
            }
        });
    }

    std::size_t triangle_number(std::size_t i) const {
        return triangles_order_.empty() ? i : static_cast<std::size_t>(triangles_order_[i]);
    }

    /// How many triangles with vertex normals precede each run, and the total.
    std::vector<std::size_t> smooth_before_runs(std::size_t count) const {
        std::vector<std::size_t> before((count + run_length - 1) / run_length + 1, 0);
        for_each_run(count, run_length, options_.threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                before[first / run_length + 1] += triangles_.is_smooth(triangle_number(i)) ? 1 : 0;
            }
        });
        for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
        return before;
    }

    /// Only where it takes little time, a step for each light, triangle and primitive.
    bool lists_casters() const {
        constexpr double most_steps = 1 << 24;
        const std::size_t primitives = flat_.spheres.size() + flat_.cones.size();
        const double steps = static_cast<double>(scene_.lights.size()) *
                             static_cast<double>(flat_.triangles.size()) *
                             static_cast<double>(primitives);
        return options_.caster_lists && flat_.params.triangle_root == 0 &&
               flat_.triangles.size() < bvh_crossover && steps <= most_steps;
    }

    void flatten_lights() {
        if (!material_use_.reflects_lights) return;
        const bool lists = lists_casters();
        for (const Scene::Light& light : scene_.lights) {
            if (is_black(light.intensity)) continue;
            typename Flat<T>::Light flat{};
            flat.position = pack_position<T>(view_, light.position);
            flat.intensity = pack<T>(light.intensity);
            flat.caster_count = static_cast<Index>(flat_.triangles.size());
            if (lists) list_casters(light.position, flat);
            flat_.lights.push_back(flat);
            light_positions_.push_back(light.position);
            flat_.stats.casters += static_cast<std::uint64_t>(flat.caster_count);
            flat_.stats.lit_triangles += flat_.triangles.size();
        }
    }

    /// Of very many lights only the first: this takes time for each light and primitive.
    void note_touched_lights() {
        constexpr std::size_t own_bits = f32::RT_TOUCHES_LIGHTS - 1, most_pairs = 1 << 27;
        const std::size_t primitives = flat_.spheres.size() + flat_.cones.size();
        if (primitives == 0) return;
        const std::size_t most = std::max(own_bits, most_pairs / primitives);
        if (light_positions_.size() > most) light_positions_.resize(most);
        const auto note = [&](auto& flat, const auto& listing, const Order& order,
                              const auto& side_of) {
            for_each(flat.size(), [&](std::size_t i) {
                const auto& primitive =
                    listing[order.empty() ? i : static_cast<std::size_t>(order[i])];
                for (std::size_t light = 0; light < light_positions_.size(); ++light) {
                    const Index side = side_of(view_, primitive, light_positions_[light], 64);
                    flat[i].touches |=
                        side << (f32::RT_TOUCHES_FIRST_LIGHT + 2 * std::min(light, own_bits));
                }
            });
        };
        note(flat_.spheres, scene_.spheres, spheres_order_, side_of_sphere<T>);
        note(flat_.cones, scene_.cones, cones_order_, side_of_cone<T>);
    }

    void list_casters(const glm::dvec3& position, typename Flat<T>::Light& light) {
        const auto casters =
            shadow_casters(scene_, triangles_, eye_ray_origins(view_, scene_), position);
        if (casters.size() == flat_.triangles.size()) return;
        light.first_caster = static_cast<Index>(flat_.casters.size());
        light.caster_count = static_cast<Index>(casters.size());
        for (const std::size_t triangle : casters) {
            flat_.casters.push_back(static_cast<Index>(triangle));
        }
    }

    void number_primitives() {
        if (spheres_order_.empty() && cones_order_.empty() && triangles_order_.empty()) return;
        flat_.order.reserve(flat_.spheres.size() + flat_.cones.size() + flat_.triangles.size());
        append_order(spheres_order_, flat_.spheres.size());
        append_order(cones_order_, flat_.cones.size());
        append_order(triangles_order_, flat_.triangles.size());
    }

    void append_order(const Order& order, std::size_t count) {
        const auto start = static_cast<Index>(flat_.order.size());
        for (std::size_t i = 0; i < count; ++i) {
            flat_.order.push_back(start + (order.empty() ? static_cast<Index>(i) : order[i]));
        }
    }

    void set_features() {
        Features& features = flat_.features;
        features[feature::spheres] = !flat_.spheres.empty();
        features[feature::huge_spheres] =
            std::ranges::any_of(flat_.spheres, [](const auto& one) { return one.is_huge != 0; });
        features[feature::eye_on_surface] = flat_.params.eye_on_surface != 0;
        features[feature::cones] = !flat_.cones.empty();
        features[feature::triangles] = !flat_.triangles.empty();
        features[feature::vertex_normals] = !flat_.vertex_normals.empty();
        features[feature::hierarchy] = !flat_.nodes.empty();
        features[feature::lights] = !flat_.lights.empty();
        features[feature::mirrors] = scene_.max_bounces > 0 && material_use_.mirrors;
        features[feature::glass] = scene_.max_bounces > 0 && material_use_.transmits;
        features[feature::edges] = flat_.params.tolerance > 0;
        features[feature::sobol] = flat_.params.sampling == f32::RT_SAMPLES_SOBOL;
        features[feature::filters] = flat_.params.filter != f32::RT_FILTER_BOX;
    }

    const Scene& scene_;
    FlattenOptions options_;
    const TriangleList triangles_;
    ViewFrame view_;
    MaterialUse material_use_;
    Order spheres_order_, cones_order_, triangles_order_;
    std::vector<glm::dvec3> light_positions_;    ///< of flat_.lights, by the author
    std::atomic<bool> eye_is_in_plane_ = false;  ///< of a triangle
    FlatScene<T> flat_{};
};

}  // namespace

template <typename T>
std::size_t FlatScene<T>::bytes() const {
#define RT_BYTES(type, name, what) +name.size() * sizeof(name[0])
    return 0 RT_SCENE_ARRAYS(RT_BYTES);
#undef RT_BYTES
}

template <typename T>
FlatScene<T> flatten(const Scene& scene, const FlattenOptions& options) try {
    return Flattener<T>(scene, options).run();
} catch (const Error& error) {
    throw Error(error.exit_code(), scene.name + ": " + error.what());
}

template struct FlatScene<float>;
template struct FlatScene<double>;
template FlatScene<float> flatten(const Scene&, const FlattenOptions&);
template FlatScene<double> flatten(const Scene&, const FlattenOptions&);

}  // namespace rt
