// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rt {

/// Which of the robust techniques kernels are to do without, each replaced by what a textbook says
/// (kernels/naive): to show what it costs and what it is good for.
struct Techniques {
    bool spheres = false;
    bool triangles = false;
    bool boxes = false;
    bool ties = false;
    bool points = false;
    bool offsets = false;
    bool lobe = false;
    bool arithmetic = false;

    bool any() const;
};

/// One technique: its switch and name, what the kernels do and what they do without it.
struct Technique {
    bool Techniques::*flag;
    const char* name;
    const char* macro;  ///< of kernels/naive/techniques.h; null: an option of the compiler's
    const char* robust;
    const char* naive;
};

inline constexpr std::array<Technique, 8> techniques{{
    {&Techniques::spheres, "spheres", "RT_NAIVE_SPHERES", "closest approach to the centre",
     "b^2 - 4 a c"},
    {&Techniques::triangles, "triangles", "RT_NAIVE_TRIANGLES",
     "shear, edges by differences of products", "Moller-Trumbore, |det| < 1e-8"},
    {&Techniques::boxes, "boxes", "RT_NAIVE_BOXES", "margins for rounding", "plain slabs"},
    {&Techniques::ties, "ties", "RT_NAIVE_TIES", "ties by number, points off shared edges",
     "the first found"},
    {&Techniques::points, "points", "RT_NAIVE_POINTS", "points put back on their surface",
     "origin + t dir"},
    {&Techniques::offsets, "offsets", "RT_NAIVE_OFFSETS",
     "bounded offsets, rays know what they leave", "+ 1e-4 n"},
    {&Techniques::lobe, "lobe", "RT_NAIVE_LOBE", "Blinn lobe from l + v", "pow(n.h, e)"},
    {&Techniques::arithmetic, "arithmetic", nullptr, "one rounding per operation",
     "the compiler contracts"},
}};

/// All of them.
Techniques all_techniques();

/// The names of those to do without.
std::vector<std::string> names_of(const Techniques& naive);

/// Those with these names. Throws Error (usage), naming `option`, for a name that is none.
Techniques techniques_named(const std::string& option, const std::vector<std::string>& names);

}  // namespace rt
