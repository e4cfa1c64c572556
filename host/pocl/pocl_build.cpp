// SPDX-License-Identifier: Apache-2.0
#include "host/pocl/pocl_build.h"

#include "host/pocl/pocl_cache.h"

namespace rt {

std::string pocl_build_advice() {
    const std::string why = why_pocl_cache_is_read_only();
    if (why.empty()) return "update the driver";
    return "PoCL cannot write its kernel cache (" + why +
           "): set POCL_CACHE_DIR to a writable folder";
}

}  // namespace rt
