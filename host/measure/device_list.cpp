// SPDX-License-Identifier: Apache-2.0
#include "host/measure/device_list.h"

#include <algorithm>
#include <optional>

#include "host/base/console.h"
#include "host/opencl/device_spec.h"
#include "host/opencl/pocl.h"
#include "host/process/drivers.h"

namespace rt {

namespace {

ListedDevice list_entry(const ClDevice& device) {
    ListedDevice entry{std::to_string(device.index), {}, device.name};
    entry.choice.device = device;
    return entry;
}

ListedDevice threads_entry(const std::string& spec, int threads) {
    return {spec, threads_choice(threads), "threads"};
}

void add_once(std::vector<ListedDevice>& list, const ListedDevice& device) {
    const bool known = std::any_of(list.begin(), list.end(), [&](const ListedDevice& other) {
        return other.spec == device.spec;
    });
    if (!known) list.push_back(device);
}

void add_all(std::vector<ListedDevice>& list, const ClDeviceList& all) {
    add_once(list, threads_entry("threads", 0));
    for (const ClDevice& device : all.devices) {
        if (device.unusable.empty()) {
            add_once(list, list_entry(device));
        } else {
            print_note("skipping " + device.name + ": " + device.unusable);
        }
    }
    print_notes(all.problems);
}

}  // namespace

std::vector<ListedDevice> listed_devices(const std::vector<std::string>& specs) {
    std::vector<ListedDevice> list;
    std::optional<ClDeviceList> all;
    const auto listed = [&]() -> const ClDeviceList& {
        if (all) return *all;
        prepare_pocl(0);
        const DriverTask task(listing_devices);
        return all.emplace(list_cl_devices());
    };
    for (const std::string& text : specs) {
        const DeviceSpec spec = parse_device_specs(text).front();
        if (spec.kind == DeviceSpec::Kind::all) {
            add_all(list, listed());
        } else if (spec.kind == DeviceSpec::Kind::threads) {
            add_once(list, threads_entry(text, spec.threads));
        } else {
            const DeviceChoice choice = choose_device(text, listed());
            add_once(list,
                     choice.use_threads ? threads_entry("threads", 0) : list_entry(choice.device));
        }
    }
    return list;
}

}  // namespace rt
