// SPDX-License-Identifier: Apache-2.0
#include "tests/native_probes.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <map>
#include <utility>

#include "host/base/error.h"

namespace rt {

namespace {

constexpr std::size_t most_arrays = 20;

[[noreturn]] void refuse(const std::string& what) { throw Error(ExitCode::device, what); }

void check_processor() {
#ifdef __x86_64__
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
        refuse("the native probes need a processor with AVX2 and FMA");
    }
#endif
}

/// One precision and width, loaded once.
void* library(bool double_precision, int lanes) {
    static std::map<std::pair<bool, int>, void*> libraries;
    void*& handle = libraries[{double_precision, lanes}];
    if (handle != nullptr) return handle;
    check_processor();
    const std::string path = fmt::format("{}/probes_{}_{}.so", MIRRORBALL_PROBES_DIR,
                                         double_precision ? "double" : "float", lanes);
    handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) refuse(dlerror());
    return handle;
}

template <std::size_t>
using Array = void*;

/// Calls a probe with sizeof...(I) arrays.
template <std::size_t... I>
void call(void* probe, std::uint32_t packet, std::uint32_t count, void* const* arrays,
          std::index_sequence<I...>) {
    using Probe = void (*)(std::uint32_t, std::uint32_t, Array<I>...);
    reinterpret_cast<Probe>(probe)(packet, count, arrays[I]...);
}

using Call = void (*)(void*, std::uint32_t, std::uint32_t, void* const*);

template <std::size_t... N>
constexpr std::array<Call, sizeof...(N)> calls(std::index_sequence<N...>) {
    return {[](void* probe, std::uint32_t packet, std::uint32_t count, void* const* arrays) {
        call(probe, packet, count, arrays, std::make_index_sequence<N>());
    }...};
}

}  // namespace

void run_native_probe(bool double_precision, int lanes, const std::string& function,
                      std::uint32_t count, std::span<void* const> arrays) {
    static constexpr auto call_with = calls(std::make_index_sequence<most_arrays + 1>());
    if (arrays.size() > most_arrays) refuse("a probe of more than 20 arrays");
    void* const probe = dlsym(library(double_precision, lanes), ("probe_" + function).c_str());
    if (probe == nullptr) refuse(dlerror());
    const auto width = static_cast<std::uint32_t>(lanes);
    for (std::uint32_t packet = 0; packet < (count + width - 1) / width; ++packet) {
        call_with[arrays.size()](probe, packet, count, arrays.data());
    }
}

}  // namespace rt
