// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "host/base/text.h"
#include "host/flatten/features.h"
#include "host/record/describe.h"
#include "host/render/rect.h"
#include "host/scene/aa_mode.h"

namespace rt {

enum class Precision { float32, float64 };

inline constexpr Named<Precision> precision_names[] = {{"float", Precision::float32},
                                                       {"double", Precision::float64}};
constexpr auto& enum_names(Precision) { return precision_names; }
inline const char* to_string(Precision precision) { return name_of(precision_names, precision); }

/// The precision of renderers that compute in T.
template <typename T>
inline constexpr Precision precision_of = sizeof(T) == sizeof(double) ? Precision::float64
                                                                      : Precision::float32;

/// strict: the same bits everywhere; fast: an OpenCL compiler may contract a * b + c.
enum class Math { strict, fast };

inline constexpr Named<Math> math_names[] = {{"strict", Math::strict}, {"fast", Math::fast}};
constexpr auto& enum_names(Math) { return math_names; }
inline const char* to_string(Math math) { return name_of(math_names, math); }

/// All that identifies a picture besides its scene. In strict math, pictures of equal scenes and
/// specs have equal bits, whatever renders them.
struct PictureSpec {
    int width = 0, height = 0;  ///< of the whole picture, pixels
    Rect region;                ///< the part to render
    AaMode aa;
    Filter filter = Filter::box;
    int seed = 0;         ///< of sobol samples
    int max_bounces = 8;  ///< mirror and refracted rays in a row after the eye ray
    Precision precision = Precision::float32;
    Math math = Math::strict;

    bool operator==(const PictureSpec&) const = default;
};

/// "100x80+10+0 of 200x80, grid:2, box filter, seed 0, 8 bounces, float, strict math", for a
/// picture's metadata.
inline std::string to_string(const PictureSpec& spec) {
    return fmt::format("{}x{}+{}+{} of {}x{}, {}, {} filter, seed {}, {} bounces, {}, {} math",
                       spec.region.width, spec.region.height, spec.region.x, spec.region.y,
                       spec.width, spec.height, to_string(spec.aa), to_string(spec.filter),
                       spec.seed, spec.max_bounces, to_string(spec.precision),
                       to_string(spec.math));
}

template <typename A, Of<PictureSpec> X>
void describe(A& a, X& x) {
    a("width", x.width, "pixels of the whole picture");
    a("height", x.height, "pixels of the whole picture");
    a("region", x.region, "the rendered part: x, y of its top left pixel, width, height");
    a("aa", x.aa, "anti-aliasing mode, as for --aa");
    a("samples", or_null(x.aa.fixed_samples()), "per pixel; null where they differ");
    a("filter", x.filter, "reconstruction filter");
    a("seed", x.seed, "of sobol samples");
    a("max_bounces", x.max_bounces, "mirror and refracted rays in a row after the eye ray");
    a("precision", x.precision, "of the arithmetic");
    a("math", x.math, "strict: the same bits on every device");
}

/// What a work item of an OpenCL device is.
enum class Launch {
    automatic,  ///< pixel on CPUs, sample elsewhere
    pixel,      ///< a pixel
    sample,     ///< a sample; a second kernel averages them
};

/// Which build of the kernels renders a picture. It costs or saves time and decides no bit.
struct KernelChoice {
    int lanes = 0;         ///< rays of a packet: 1, 2, 4, 8 or 16; 0: as suits the device
    std::string isa = {};  ///< instruction set of the threads' kernels; empty: the best here
    Launch launch = Launch::automatic;  ///< of OpenCL devices
    Features features;                  ///< compiled in although the scene may not need them
    bool any_samples = false;           ///< a loop over samples, although the count is known
    std::string cl_options = {};        ///< further ones for the compilers of OpenCL drivers
    std::size_t group = 0;              ///< work items of an OpenCL work group; 0: as is best
};

/// How the threads of the pthreads renderer share the work.
enum class Schedule {
    tiles,    ///< threads take tiles from a shared counter
    buffers,  ///< the paper's: a thread renders whole sample buffers, averaged at the end
};

inline constexpr Named<Schedule> schedule_names[] = {{"tiles", Schedule::tiles},
                                                     {"buffers", Schedule::buffers}};
constexpr auto& enum_names(Schedule) { return schedule_names; }
inline const char* to_string(Schedule schedule) { return name_of(schedule_names, schedule); }

}  // namespace rt
