// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/base/text.h"
#include "host/flatten/flat_scene.h"
#include "host/flatten/triangle_list.h"
#include "host/record/describe.h"
#include "host/scene/scene.h"
#include "kernels/native/path_event.h"

namespace rt {

/// A pixel, and all events of its paths, in the order in which they happened
/// (kernels/native/explain.cl).
struct ExplainedPixel {
    glm::dvec3 color{0};
    std::vector<PathEvent> events;
};

/// Renders one pixel in double, one ray at a time; x and y count from the top left. The same bits
/// as in a picture.
ExplainedPixel explain_pixel(const FlatScene<double>& scene, int x, int y);

/// The scene's number of a primitive of its flat scene, kind by kind as the scene lists them.
template <typename T>
std::size_t number_in_scene(const FlatScene<T>& flat, std::int64_t prim) {
    const auto number = static_cast<std::size_t>(prim);
    return flat.order.empty() ? number : static_cast<std::size_t>(flat.order[number]);
}

/// What its author calls it: "sphere 2"; "triangle 7"; "mesh 1, triangle 23": counted from 1.
std::string object_of(const Scene& scene, const TriangleList& triangles, std::size_t number);

/// The lights that the flat scene has: those of nonzero intensity.
std::vector<std::size_t> shining_lights(const Scene& scene);

/// One light as seen from a hit.
struct LightAtHit {
    enum class State { behind, shadowed, lit };

    std::size_t light = 0;  ///< index into Scene::lights
    State state = State::behind;
    glm::dvec3 color{0};  ///< what it adds
};

inline constexpr Named<LightAtHit::State> light_states[] = {
    {"behind", LightAtHit::State::behind},
    {"shadowed", LightAtHit::State::shadowed},
    {"lit", LightAtHit::State::lit}};
constexpr auto& enum_names(LightAtHit::State) { return light_states; }

/// Where a ray met a surface, in scene units.
struct RayHit {
    std::string object;    ///< as object_of says
    std::string material;  ///< its name
    double distance = 0;
    glm::dvec3 point{0}, normal{0};
    glm::dvec3 ambient{0};
    std::vector<LightAtHit> lights;
};

/// A ray, what it hit, and its secondary rays. Positions are in scene units.
struct RayNode {
    enum class Kind { eye, mirror, refracted };

    Kind kind = Kind::eye;
    int bounce = 0;
    glm::dvec3 weight{1};  ///< of its color in the sample's color
    glm::dvec3 origin{0}, direction{0};
    std::optional<RayHit> hit;  ///< empty: it saw the background
    glm::dvec3 color{0};        ///< local light, or the background, before weighting
    std::vector<RayNode> children;
};

inline constexpr Named<RayNode::Kind> ray_kinds[] = {{"eye", RayNode::Kind::eye},
                                                     {"mirror", RayNode::Kind::mirror},
                                                     {"refracted", RayNode::Kind::refracted}};
constexpr auto& enum_names(RayNode::Kind) { return ray_kinds; }

/// A sample's ray tree. The sum of weight x color over its nodes is the sample's color.
struct SampleTree {
    int number = 0;
    RayNode ray;
};

/// The trees of a pixel's samples. `flat` must be the scene's.
std::vector<SampleTree> ray_trees(const ExplainedPixel& pixel, const Scene& scene,
                                  const FlatScene<double>& flat);

/// `before` plus the tree's color, summed in the renderer's order: the same bits.
glm::dvec3 color_of(const RayNode& ray, const glm::dvec3& before = glm::dvec3(0));

/// The trees as indented lines: a ray, what it hit, what each light adds, and the secondary rays;
/// if not `all`, then without those that weigh too little to be seen.
std::string ray_trees_text(const std::vector<SampleTree>& trees, bool all);

// "samples" of `explain --json` (docs/results-format.md).

inline std::vector<double> numbers_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

template <typename A, Of<LightAtHit> X>
void describe(A& a, X& x) {
    a("light", x.light + 1, "its number in the scene, from 1");
    a("state", x.state, "");
    a("color", numbers_of(x.color), "what it adds");
}

template <typename A, Of<RayHit> X>
void describe(A& a, X& x) {
    a("object", x.object, "its kind and number, from 1");
    a("material", printable(x.material), "its name");
    a("distance", x.distance, "");
    a("point", numbers_of(x.point), "");
    a("normal", numbers_of(x.normal), "");
    a("ambient", numbers_of(x.ambient), "ambient light");
    a("lights", x.lights, "");
}

template <typename A, Of<RayNode> X>
void describe(A& a, X& x) {
    a("kind", x.kind, "");
    a("bounce", x.bounce, "");
    a("weight", numbers_of(x.weight), "of its color in the sample's color");
    a("origin", numbers_of(x.origin), "");
    a("direction", numbers_of(x.direction), "");
    a("hit", or_null(x.hit), "null: it saw the background");
    a("color", numbers_of(x.color), "local light, or the background");
    a("children", x.children, "");
}

template <typename A, Of<SampleTree> X>
void describe(A& a, X& x) {
    a("sample", x.number, "from 0");
    a("color", numbers_of(color_of(x.ray)), "");
    a("ray", x.ray, "from the eye");
}

}  // namespace rt
