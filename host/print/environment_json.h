// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rt {

/// The processor's name; "unknown" where the system does not report it.
std::string cpu_name();

/// The machine and program behind a result: program, git revision, compiler, CPU, cores, memory,
/// operating system, kernel, load.
nlohmann::ordered_json environment_json();

}  // namespace rt
