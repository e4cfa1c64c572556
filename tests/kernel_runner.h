// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/selftest/selftest.h"

// Runs the probe kernels of kernels/probes/probes.cl. To test a new device function, add a probe
// there and
//
//     KERNEL_SUITE(Dot3);
//     TYPED_TEST(Dot3, IsExactOnSmallIntegers) {
//         const auto sum = run<TypeParam, TypeParam>("dot3", a.size(), a, b);
//         ...
//     }
//
// The device is the one MIRRORBALL_TEST_DEVICE names (as --device does), else the first PoCL
// device, else the first that can render; `none` takes the native probes for it, without OpenCL.
namespace rt {

/// Runs a probe as ProbeDevice::launch does. Builds the probes on first use, once per precision and
/// arithmetic, on PoCL with warnings as errors. In strict arithmetic the same probe also runs on
/// this processor, in packets of every width, and the test fails if any bit differs; all NaNs are
/// equal, since IEEE 754 leaves sign and payload to the machine. Throws Error (ExitCode::device)
/// that names the device, the probe and the OpenCL status.
void launch_probe(ProbeRecord& launch);

/// During its lifetime, probes are built for `--math fast`: the compiler may contract.
class FastMath {
   public:
    FastMath();
    ~FastMath();
    FastMath(const FastMath&) = delete;
    FastMath& operator=(const FastMath&) = delete;
};

/// The test device's name, and whether it has the double type.
std::string test_device_name();
bool test_device_has_double();

/// Whether results of this type hold integers only.
template <typename X>
inline constexpr bool is_integers = std::is_integral_v<X>;
template <>
inline constexpr bool is_integers<f32::RayCounts> = true;
template <>
inline constexpr bool is_integers<f64::RayCounts> = true;

/// Untyped: a template is compiled for each type, in every test file.
void add_input(ProbeRecord& launch, const void* values, std::size_t bytes,
               std::uint32_t item_bytes);

template <typename X>
void add_inputs(ProbeRecord& launch, const std::vector<X>& values) {
    add_input(launch, values.data(), values.size() * sizeof(X), sizeof(X));
}

/// A scene is ten arguments, the PROBE_SCENE of probes.cl.
template <typename T>
void add_inputs(ProbeRecord& launch, const FlatScene<T>& scene) {
#define RT_PROBE_ARRAY(type, name, what) \
    add_input(launch, scene.name.data(), scene.name.size() * sizeof(scene.name[0]), 0);
    RT_SCENE_ARRAYS(RT_PROBE_ARRAY)
#undef RT_PROBE_ARRAY
    add_input(launch, &scene.params, sizeof(scene.params), 0);
}

/// Runs probe_FUNCTION in the precision of T over `count` items. Inputs are vectors and scenes; the
/// results are a vector for each type in Outs, in a tuple if there are several.
template <typename T, typename... Outs, typename... Ins>
auto run(const std::string& function, std::size_t count, const Ins&... ins) {
    ProbeRecord launch{
        function, std::is_same_v<T, double>, static_cast<std::uint32_t>(count), {}, {}};
    (add_inputs(launch, ins), ...);
    (launch.outputs.push_back(
         {std::vector<std::byte>(count * sizeof(Outs)), sizeof(Outs), !is_integers<Outs>}),
     ...);
    launch_probe(launch);
    std::tuple<std::vector<Outs>...> results{std::vector<Outs>(count)...};
    auto output = launch.outputs.begin();
    std::apply(
        [&](auto&... out) {
            ((std::memcpy(out.data(), output->bytes.data(), output->bytes.size()), ++output), ...);
        },
        results);
    if constexpr (sizeof...(Outs) == 1) {
        return std::get<0>(std::move(results));
    } else {
        return results;
    }
}

/// Whether two arrays of T, or of structs made of T and Flat<T>::Index, hold the same bits. All
/// NaNs are equal: IEEE 754 leaves sign and payload to the machine.
template <typename T, typename X>
testing::AssertionResult same_bits(const std::vector<X>& device, const std::vector<X>& expected) {
    static_assert(sizeof(X) % sizeof(T) == 0 && std::is_trivially_copyable_v<X>);
    if (device.size() != expected.size()) return testing::AssertionFailure() << "different lengths";
    constexpr std::size_t words = sizeof(X) / sizeof(T);
    for (std::size_t i = 0; i < device.size(); ++i) {
        T a[words], b[words];
        std::memcpy(a, &device[i], sizeof(X));
        std::memcpy(b, &expected[i], sizeof(X));
        for (std::size_t k = 0; k < words; ++k) {
            const bool both_nan = a[k] != a[k] && b[k] != b[k];
            if (both_nan || std::memcmp(&a[k], &b[k], sizeof(T)) == 0) continue;
            return testing::AssertionFailure() << "item " << i << ", number " << k << ": device "
                                               << std::hexfloat << a[k] << ", expected " << b[k];
        }
    }
    return testing::AssertionSuccess();
}

/// A test in one precision; skipped where the device has no double.
template <typename T>
class KernelTest : public testing::Test {
   protected:
    void SetUp() override {
        if (std::is_same_v<T, double> && !test_device_has_double()) {
            GTEST_SKIP() << test_device_name() << " has no double precision (cl_khr_fp64)";
        }
    }
};

using Reals = testing::Types<float, double>;

struct RealNames {
    template <typename T>
    static std::string GetName(int) {
        return std::is_same_v<T, float> ? "float" : "double";
    }
};

/// A suite of TYPED_TESTs that run in float and in double.
#define KERNEL_SUITE(name)          \
    template <typename T>           \
    using name = rt::KernelTest<T>; \
    TYPED_TEST_SUITE(name, rt::Reals, rt::RealNames)

}  // namespace rt
