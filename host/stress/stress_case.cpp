// SPDX-License-Identifier: Apache-2.0
#include "host/stress/stress_case.h"

#include <fnmatch.h>

#include <algorithm>

#include "host/base/error.h"
#include "host/stress/families.h"

namespace rt {

namespace {

bool fits_any(const std::vector<std::string>& globs, const std::string& family,
              const std::string& label) {
    return std::any_of(globs.begin(), globs.end(),
                       [&](const std::string& glob) { return fits_glob(glob, family, label); });
}

void check_glob(const std::string& glob, const std::vector<StressFamily>& families) {
    std::string names;
    for (const StressFamily& family : families) {
        for (const StressCase& one : family.cases) {
            if (fits_glob(glob, family.name, one.label)) return;
        }
        names += "\n  " + family.name;
    }
    usage_error("'{}' matches no stress case; the families are:{}", glob, names);
}

}  // namespace

bool fits_glob(const std::string& glob, const std::string& family, const std::string& label) {
    const std::string whole = family + "/" + label;
    return fnmatch(glob.c_str(), family.c_str(), 0) == 0 ||
           fnmatch(glob.c_str(), whole.c_str(), 0) == 0;
}

std::vector<StressFamily> chosen_families(std::vector<StressFamily> families,
                                          const std::vector<std::string>& globs,
                                          const std::vector<std::string>& unwanted,
                                          bool quick_only) {
    for (const auto* list : {&globs, &unwanted}) {
        for (const std::string& glob : *list) check_glob(glob, families);
    }
    for (StressFamily& family : families) {
        std::erase_if(family.cases, [&](const StressCase& one) {
            return (!globs.empty() && !fits_any(globs, family.name, one.label)) ||
                   fits_any(unwanted, family.name, one.label) || (quick_only && !one.quick);
        });
    }
    std::erase_if(families, [](const StressFamily& family) { return family.cases.empty(); });
    if (families.empty()) {
        usage_error("no case is left to run; omit --quick or --except");
    }
    return families;
}

std::vector<StressFamily> all_stress_families() {
    std::vector<StressFamily> all;
    for (const auto families : {ordinary_families, shape_families, glass_families, light_families,
                                eye_families, triangle_families, mesh_families, ray_families}) {
        for (StressFamily& family : families()) all.push_back(std::move(family));
    }
    return all;
}

}  // namespace rt
