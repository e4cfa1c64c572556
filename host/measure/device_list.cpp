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

void add_once(std::vector<ListedDevice>& list, const ListedDevice& device) {
    if (std::ranges::count(list, device.spec, &ListedDevice::spec) == 0) list.push_back(device);
}

void add_device(std::vector<ListedDevice>& list, const ClDevice& device) {
    add_once(list, {std::to_string(device.index), {.device = device}, device.name});
}

void add_threads(std::vector<ListedDevice>& list, const std::string& spec, int threads) {
    add_once(list, {spec, threads_choice(threads), "threads"});
}

void add_all(std::vector<ListedDevice>& list, const ClDeviceList& all) {
    add_threads(list, "threads", 0);
    for (const ClDevice& device : all.devices) {
        if (device.unusable.empty()) {
            add_device(list, device);
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
            add_threads(list, text, spec.threads);
        } else {
            const DeviceChoice choice = choose_device(text, listed());
            choice.use_threads ? add_threads(list, "threads", 0) : add_device(list, choice.device);
        }
    }
    return list;
}

}  // namespace rt
