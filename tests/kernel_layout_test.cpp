// SPDX-License-Identifier: Apache-2.0
//
// The device's layout of the structs of kernels/shared.h against C++'s: the size of each, and
// offset and size of each member.
#include <cstddef>
#include <numeric>

#include "tests/kernel_runner.h"

namespace rt {

namespace {

struct Field {
    const char* name;
    std::uint64_t offset, bytes;
    bool is_struct;
};

/// What a probe answers.
struct ProbeField {
    std::uint64_t offset, bytes;
};

#define RT_STRUCT(type) {#type, 0, sizeof(typename Flat<T>::type), true},
#define RT_FIELD(type, member)                                    \
    {#type "." #member, offsetof(typename Flat<T>::type, member), \
     sizeof(std::declval<typename Flat<T>::type>().member), false},
template <typename T>
std::vector<Field> host_layout() {
    return {
#include "kernels/probes/layout_fields.h"
    };
}
#undef RT_STRUCT
#undef RT_FIELD

KERNEL_SUITE(SharedStructs);

TYPED_TEST(SharedStructs, LieOnTheDeviceAsInCpp) {
    const auto host = host_layout<TypeParam>();
    const auto device = run<TypeParam, ProbeField>("layout", host.size());
    for (std::size_t i = 0; i < host.size(); ++i) {
        EXPECT_EQ(device[i].offset, host[i].offset) << host[i].name;
        EXPECT_EQ(device[i].bytes, host[i].bytes) << host[i].name;
    }
}

TYPED_TEST(SharedStructs, HaveNoHolesAndNoUnlistedMembers) {
    std::uint64_t end = 0, size = 0;
    for (const Field& field : host_layout<TypeParam>()) {
        if (field.is_struct) {
            EXPECT_EQ(end, size) << "before " << field.name;
            end = 0;
            size = field.bytes;
        } else {
            EXPECT_EQ(field.offset, end) << field.name;
            end = field.offset + field.bytes;
        }
    }
    EXPECT_EQ(end, size);
}

TYPED_TEST(SharedStructs, AreMadeOfRowsOfFourNumbers) {
    for (const Field& field : host_layout<TypeParam>()) {
        const std::string name = field.name;
        if (!field.is_struct || name == "Packed3" || name == "RayCounts") continue;
        EXPECT_EQ(field.bytes % (4 * sizeof(TypeParam)), 0u) << name;
    }
}

}  // namespace

}  // namespace rt
