// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "host/flatten/features.h"
#include "host/render/launch.h"

namespace rt {

class OpenDevices;

/// Contexts and programs kept from picture to picture (cl_program.h).
std::shared_ptr<OpenDevices> make_open_devices();

struct ClOptions {
    Launch launch = Launch::automatic;
    int lanes = 0;  ///< rays of a packet: 1, 2, 4, 8 or 16; 0: as suits the device
    bool fast_math = false;
    bool will_refine = false;             ///< also build the kernel that `refine` needs
    bool all_features = false;            ///< also compile what scene and renderer do not need
    Features also = no_features();        ///< compile these, needed or not
    bool any_samples = false;             ///< compile the loop over samples, needed or not
    bool shares_film = false;             ///< others render into the film at the same time
    bool warnings_are_errors = false;     ///< for tests
    OpenDevices* open_devices = nullptr;  ///< caches context and program; null: no cache
};

}  // namespace rt
