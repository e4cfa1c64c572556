// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "host/base/hash.h"
#include "host/picture/crew.h"
#include "host/record/record.h"
#include "host/selftest/selftest.h"

namespace rt::this_file {
namespace {

/// scenes/golden.json is what threads render. MIRRORBALL_WRITE_GOLDEN=1 writes it.
TEST(GoldenPictures, AreWhatThreadsRender) {
    RenderCache cache;
    std::map<std::string, std::string> hashes;
    const std::vector<GoldenPicture> pictures = golden_pictures();
    for (const GoldenPicture& picture : pictures) {
        const RenderedPicture rendered = render_golden(picture, threads_choice(), {}, &cache);
        hashes[picture.name()] = hash_text(rendered.stats.image_hash);
    }
    const std::string text = json_text({{"format", "mirrorball-golden"},
                                        {"version", 1},
                                        {"width", golden_scene(pictures.front()).width},
                                        {"pictures", hashes}});
    const std::string path = MIRRORBALL_SCENES_DIR "/golden.json";
    if (std::getenv("MIRRORBALL_WRITE_GOLDEN") != nullptr) std::ofstream(path) << text;
    std::ostringstream found;
    found << std::ifstream(path).rdbuf();
    EXPECT_EQ(found.str(), text) << path << " is out of date; set MIRRORBALL_WRITE_GOLDEN=1";
}

}  // namespace
}  // namespace rt::this_file
