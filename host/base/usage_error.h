// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <utility>

#include "host/base/error.h"

namespace rt {

/// Rejects the command line: throws Error (ExitCode::usage) with the formatted message.
template <typename... Values>
[[noreturn]] void usage_error(fmt::format_string<Values...> format, Values&&... values) {
    throw Error(ExitCode::usage, fmt::format(format, std::forward<Values>(values)...));
}

}  // namespace rt
