// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "host/base/text.h"
#include "host/flatten/features.h"

namespace rt {

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
    Features features = no_features();  ///< compiled in although the scene may not need them
    bool any_samples = false;           ///< a loop over samples, although the count is known
    std::string cl_options = {};        ///< further ones for the compilers of OpenCL drivers
    std::size_t group = 0;              ///< work items of an OpenCL work group; 0: as is best

    /// Whether everything is compiled in.
    bool has_all() const { return features == Features{}; }
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
