// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "host/render/kernel_choice.h"
#include "host/render/picture_spec.h"

namespace rt {

/// kernels/render.cl with its includes, embedded at build time (host/embed_kernels.cpp).
extern const char* const render_kernels;

class OpenDevices;

/// Contexts and programs kept from picture to picture (cl_program.h).
std::shared_ptr<OpenDevices> make_open_devices();

struct ClOptions {
    KernelChoice kernels{};
    Math math = Math::strict;
    bool shares_film = false;  ///< others render into the film at the same time
    std::shared_ptr<OpenDevices> open_devices = make_open_devices();
};

/// What is asked for with every build of this process.
struct BuildExtras {
    std::string options;  ///< further ones for the driver's compiler
    std::string folder;   ///< for each program's source, options, log and binary; empty: nowhere
};

BuildExtras& build_extras();

}  // namespace rt
