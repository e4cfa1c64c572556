// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <exception>
#include <string>

#include "host/image/picture_module.h"

namespace rt::module {

inline int fail(ErrorText error, const std::string& message) {
    std::snprintf(error.text, error.size, "%s", message.c_str());
    return 0;
}

/// Runs one call into a module; no exception may cross the module boundary.
template <typename Call>
int guarded(ErrorText error, Call call) {
    fail(error, "");
    try {
        return call();
    } catch (const std::exception& exception) {
        return fail(error, exception.what());
    } catch (...) {
        return fail(error, "unknown exception");
    }
}

}  // namespace rt::module
