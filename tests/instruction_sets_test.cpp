// SPDX-License-Identifier: Apache-2.0
//
// Kernels for every instruction set of this processor give the same bits, as packets and as single
// rays, with all features and with only those a scene needs.
#include <gtest/gtest.h>

#include "host/render/native_kernels.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

class EveryInstructionSet : public testing::TestWithParam<std::string> {
   protected:
    template <typename T>
    void expect_the_usual_bits() const {
        for (const auto& file : scene_files()) {
            Scene scene = load_named_scene(file.stem().string());
            set_image_size(scene, 40, 30);
            scene.aa = grid_aa(2);
            const std::uint64_t hash = hash_of(render_on_threads<T>(scene));
            for (const int lanes : {1, 0}) {
                for (const bool all_features : {false, true}) {
                    ThreadsOptions options;
                    options.kernels.isa = GetParam();
                    options.kernels.lanes = lanes;
                    if (all_features) options.kernels.features = every_feature;
                    EXPECT_EQ(hash_of(render_on_threads<T>(scene, options)), hash)
                        << file << ", lanes " << lanes << ", all features " << all_features;
                }
            }
        }
    }
};

TEST_P(EveryInstructionSet, GivesTheSameBitsInFloat) { expect_the_usual_bits<float>(); }
TEST_P(EveryInstructionSet, GivesTheSameBitsInDouble) { expect_the_usual_bits<double>(); }

INSTANTIATE_TEST_SUITE_P(Here, EveryInstructionSet, testing::ValuesIn(native_isas()),
                         [](const auto& info) {
                             std::string name = info.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace rt::test::this_file
