// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "host/render/explain.h"
#include "host/scene/scene.h"

namespace rt {

/// One light as seen from a hit.
struct LightAtHit {
    enum class State { behind, shadowed, lit };

    std::size_t light = 0;  ///< index into Scene::lights
    State state = State::behind;
    glm::dvec3 color{0};  ///< what it adds
};

/// A ray, what it hit, and its secondary rays. Positions are in scene units.
struct RayNode {
    enum class Kind { eye, mirror, refracted };

    Kind kind = Kind::eye;
    int bounce = 0;
    glm::dvec3 weight{1};  ///< of its color in the sample's color
    glm::dvec3 origin{0}, direction{0};
    bool hit = false;      ///< false: it saw the background
    std::string object;    ///< "sphere 2"; "triangle 7"; "mesh 1, face 23": counted from 1
    std::string material;  ///< its name
    double distance = 0;
    glm::dvec3 point{0}, normal{0};
    glm::dvec3 ambient{0};
    std::vector<LightAtHit> lights;
    glm::dvec3 color{0};  ///< local light, or the background, before weighting
    std::vector<RayNode> children;
};

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

}  // namespace rt
