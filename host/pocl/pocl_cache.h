// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "host/render/renderer.h"

namespace rt {

/// Tells a cold build on PoCL from a warm one: PoCL makes a library of each kernel it compiles,
/// keeps it in its cache, and loads it from there. `cold` when one of those loaded into this
/// process was written at `start` or later, `warm` when all are older, `unknown` when there is
/// none. Costs microseconds, however large the cache.
BuildCache pocl_build_since(std::filesystem::file_time_type start);

/// Where PoCL keeps kernels, once prepare_pocl has been called.
std::filesystem::path pocl_cache_folder();

/// Whether it keeps them at all: POCL_KERNEL_CACHE=0 is for its developers.
bool pocl_keeps_kernels();

/// Why PoCL cannot write its kernel cache: "FOLDER: Permission denied"; empty where it can.
std::string why_pocl_cache_is_read_only();

}  // namespace rt
