// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "host/scene/mistakes.h"
#include "host/scene/nff_tokens.h"
#include "host/scene/scene.h"

namespace rt {

/// The fills of an NFF file as materials; equal fills share one.
class NffFills {
   public:
    explicit NffFills(Mistakes& mistakes) : mistakes_(mistakes) {}

    /// Reads the arguments of an f and makes it current. Returns false when the rest of it cannot
    /// be parsed.
    bool read(NffTokens& tokens);

    /// The index of the current material; matte white before the first f.
    int current();

    std::vector<Scene::Material> take() { return std::move(materials_); }

   private:
    /// red green blue Kd Ks Shine T ior
    using Fill = std::array<double, 8>;

    void use(const Fill& fill);

    Mistakes& mistakes_;
    std::vector<Scene::Material> materials_;
    std::map<Fill, int> index_;
    int current_ = -1;  ///< -1: none was read yet
};

}  // namespace rt
