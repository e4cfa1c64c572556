// SPDX-License-Identifier: Apache-2.0
#include "host/render/native_kernels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <type_traits>

#include "host/base/error.h"
#include "native_table.h"

// The entry points of every variant, as native.cl declares them; the weak ones are not in all.
#define RT_DECLARE_ENTRY(T, name, field) \
    std::remove_pointer_t<decltype(rt::NativeKernels<T>::field)> name
#define RT_DECLARE_NATIVE(T, name)                                             \
    extern "C" {                                                               \
    extern const int name##_traits[3];                                         \
    RT_DECLARE_ENTRY(T, name##_pixels, render_pixels);                         \
    RT_DECLARE_ENTRY(T, name##_pixel, render_pixel);                           \
    RT_DECLARE_ENTRY(T, name##_samples, render_samples);                       \
    RT_DECLARE_ENTRY(T, name##_resolve, resolve_samples);                      \
    RT_DECLARE_ENTRY(T, name##_centers, render_centers) __attribute__((weak)); \
    RT_DECLARE_ENTRY(T, name##_round, render_round) __attribute__((weak));     \
    RT_DECLARE_ENTRY(T, name##_rays, trace_rays) __attribute__((weak));        \
    }
#define RT_DECLARE_FLOAT(name, isa, lanes) RT_DECLARE_NATIVE(float, name)
#define RT_DECLARE_DOUBLE(name, isa, lanes) RT_DECLARE_NATIVE(double, name)
RT_NATIVE_FLOAT(RT_DECLARE_FLOAT)
RT_NATIVE_DOUBLE(RT_DECLARE_DOUBLE)

namespace rt {

namespace {

#define RT_NATIVE_ROW(name, isa, isa_lanes)             \
    {isa,                                               \
     isa_lanes,                                         \
     Features(static_cast<unsigned>(name##_traits[0])), \
     name##_traits[1],                                  \
     name##_traits[2],                                  \
     name##_pixels,                                     \
     name##_pixel,                                      \
     name##_samples,                                    \
     name##_resolve,                                    \
     name##_centers,                                    \
     name##_round,                                      \
     name##_rays},

template <typename T>
const std::vector<NativeKernels<T>>& all_kernels() {
    static const std::vector<NativeKernels<float>> in_float{RT_NATIVE_FLOAT(RT_NATIVE_ROW)};
    static const std::vector<NativeKernels<double>> in_double{RT_NATIVE_DOUBLE(RT_NATIVE_ROW)};
    if constexpr (std::is_same_v<T, float>)
        return in_float;
    else
        return in_double;
}

/// Whether the processor has what kernels use of this x86-64 level (see its psABI).
bool processor_has([[maybe_unused]] const std::string& isa) {
#ifdef __x86_64__
    if (isa == "x86-64") return true;
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") ||
        !__builtin_cpu_supports("bmi") || !__builtin_cpu_supports("bmi2")) {
        return false;
    }
    if (isa == "x86-64-v3") return true;
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    return true;
#endif
}

template <typename T>
bool serves(const NativeKernels<T>& kernels, const KernelChoice& choice, int samples) {
    const int lanes = choice.lanes == 0 ? kernels.isa_lanes : choice.lanes;
    return kernels.isa == choice.isa && kernels.lanes == lanes &&
           (kernels.samples == 0 || kernels.samples == samples) &&
           (choice.features & ~kernels.features).none();
}

}  // namespace

template <typename T>
NativeView<T> native_view(const FlatScene<T>& scene) {
#define RT_NATIVE_DATA(type, name, what) scene.name.data(),
    return {RT_SCENE_ARRAYS(RT_NATIVE_DATA) scene.params};
#undef RT_NATIVE_DATA
}

std::vector<std::string> native_isas() {
    std::vector<std::string> isas;
    for (const auto& kernels : all_kernels<float>()) {
        const std::string isa = kernels.isa;
        if (std::ranges::count(isas, isa) == 0 && processor_has(isa)) isas.push_back(isa);
    }
    return isas;
}

bool has_fast_fma(const std::string& isa) { return isa != "x86-64"; }

template <typename T>
const NativeKernels<T>& choose_native(const KernelChoice& choice, int samples) {
    const std::vector<std::string> isas = native_isas();
    KernelChoice wanted = choice;
    if (wanted.isa.empty() && !isas.empty()) wanted.isa = isas.front();
    if (std::find(isas.begin(), isas.end(), wanted.isa) == isas.end()) {
        throw Error(ExitCode::device,
                    fmt::format("this processor cannot run the kernels{}; it supports: {}",
                                wanted.isa.empty() ? "" : " for " + wanted.isa,
                                isas.empty() ? "none" : fmt::format("{}", fmt::join(isas, ", "))));
    }
    for (const NativeKernels<T>& kernels : all_kernels<T>()) {
        if (serves(kernels, wanted, samples)) return kernels;
    }
    usage_error("--lanes {} is not available for {}; use --lanes 1 or auto", wanted.lanes,
                wanted.isa);
}

template NativeView<float> native_view(const FlatScene<float>&);
template NativeView<double> native_view(const FlatScene<double>&);
template const NativeKernels<float>& choose_native(const KernelChoice&, int);
template const NativeKernels<double>& choose_native(const KernelChoice&, int);

}  // namespace rt
