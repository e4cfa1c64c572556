// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace rt {

/// The processor's name, with family and model on x86, where one name is given to many: "Intel(R)
/// Xeon(R) Processor (family 6, model 143)"; "unknown" where the system does not report it.
std::string cpu_name();

/// The machine and program behind a result: program, git revision, compiler, CPU, cores, memory,
/// operating system, kernel, load.
nlohmann::ordered_json environment_json();

}  // namespace rt
