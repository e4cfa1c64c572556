// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress.h"

#include <gtest/gtest.h>

#include <string>

namespace rt::this_file {
namespace {

TEST(ProgressLine, TellsShareRateAndTimeLeft) {
    EXPECT_EQ(progress_line(0.25, 30, {1000000, 2000000, 0}), " 25 %  0.1 Mrays/s  ETA 1:30");
    EXPECT_EQ(progress_line(0, 0, {}), "  0 %  ETA -:--");
}

TEST(ProgressBar, FitsTheTerminal) {
    const std::string line = " 42 %  12.3 Mrays/s  ETA 0:07";
    EXPECT_EQ(progress_bar(0.5, line, 80),
              "[###############...............] " + line + std::string(17, ' '));
    EXPECT_EQ(progress_bar(0.5, line, 40), "[###....] " + line);
    EXPECT_EQ(progress_bar(0.5, line, 32), line + "  ");
    EXPECT_EQ(progress_bar(0.5, line, 20), line.substr(0, 19));
    EXPECT_EQ(progress_bar(0.5, line, 0), "");
}

TEST(ProgressLine, HasNoTimeLeftOnlyWhenAllIsDone) {
    EXPECT_EQ(progress_line(0.999, 1, {}), " 99 %  ETA 0:01");
    EXPECT_EQ(progress_line(1, 1, {}), "100 %");
    EXPECT_EQ(progress_line(0, 1, {}), "  0 %  ETA -:--");
}

}  // namespace
}  // namespace rt::this_file
