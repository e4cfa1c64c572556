// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/report_settings.h"

#include <gtest/gtest.h>

#include <string>

namespace {

TEST(ReportCommands, NameTheStressSuiteWhereItWasRun) {
    rt::ReportOptions options;
    options.scenes = {"a.json"};
    options.output = "page.html";
    const auto plain = rt::report_commands(options);
    EXPECT_EQ(plain.front().find("--stress"), std::string::npos);
    options.stress = options.quick = true;
    const auto commands = rt::report_commands(options);
    EXPECT_EQ(commands.front(),
              "mirrorball report a.json -o page.html --devices all --repeats 5 --quick --stress");
    EXPECT_EQ(commands.back(), "mirrorball stress --device all --quick --json -");
    EXPECT_EQ(commands.size(), plain.size() + 1);
}

}  // namespace
