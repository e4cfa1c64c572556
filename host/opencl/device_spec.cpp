// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/device_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <system_error>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/opencl/gpu_nodes.h"
#include "host/opencl/pocl.h"

namespace rt {

namespace {

constexpr int most_threads_asked = 4096;

bool contains(const std::string& text, const std::string& part) {
    return lower(text).find(lower(part)) != std::string::npos;
}

std::string describe_all(const std::vector<ClDevice>& devices,
                         const std::vector<std::string>& problems = {}) {
    std::string text;
    if (devices.empty() && !problems.empty())
        return " none (" + problems.front() + "); see 'mirrorball devices'";
    for (const ClDevice& device : devices) {
        text += fmt::format("\n  {}  {} ({})", device.index, device.name, device.platform);
    }
    return text.empty() ? " none (see 'mirrorball devices')" : text;
}

using Test = std::function<bool(const ClDevice&)>;

/// The test for a spec that is neither threads nor "".
Test test_for(const std::string& spec) {
    const auto colon = spec.find(':');
    if (const auto index = parse_number<int>(spec); index && *index >= 0) {
        return [=](const ClDevice& device) { return device.index == *index; };
    }
    if (spec == "cpu") return [](const ClDevice& device) { return device.is_cpu; };
    if (spec == "gpu") return [](const ClDevice& device) { return device.is_gpu; };
    if (spec == "pocl") {
        return [](const ClDevice& device) { return device.platform == pocl_platform; };
    }
    if (spec.rfind("name:", 0) == 0 && spec.size() > 5) {
        const std::string text = spec.substr(5);
        return [=](const ClDevice& device) {
            return contains(device.name, text) || contains(device.platform, text) ||
                   contains(device.vendor, text);
        };
    }
    if (colon != std::string::npos) {
        const auto platform = parse_number<int>(std::string_view(spec).substr(0, colon));
        const auto index = parse_number<int>(std::string_view(spec).substr(colon + 1));
        if (platform && index && *platform >= 0 && *index >= 0) {
            return [=](const ClDevice& device) {
                return device.platform_index == *platform && device.device_index == *index;
            };
        }
    }
    usage_error(
        "device '{}': expected an index, platform:device, pocl, name:TEXT, cpu, gpu, "
        "threads[:N], all or auto, or several of them separated by commas",
        spec);
}

/// Resolves a list of specs, listing devices at most once.
class DeviceFinder {
   public:
    DeviceFinder(int threads, const std::function<void()>& loaded)
        : threads_(threads), loaded_(loaded) {}

    std::vector<DeviceChoice> find(const std::string& list) {
        std::vector<DeviceChoice> found;
        for (const std::string& spec : specs_of(list)) {
            if (spec == all_devices) {
                add(found, threads_choice());
                add_usable(found);
                continue;
            }
            const DeviceChoice choice = find_one(spec);
            add(found, choice);
            // Threads trace while the automatically chosen device still compiles.
            if (!is_auto(spec) || choice.use_threads) continue;
            DeviceChoice helper = threads_choice();
            helper.is_helper = true;
            add(found, helper);
        }
        return found;
    }

   private:
    /// Each device once, by however many names.
    static void add(std::vector<DeviceChoice>& found, const DeviceChoice& choice) {
        for (const DeviceChoice& other : found) {
            if (choice.use_threads != other.use_threads) continue;
            if (choice.use_threads && choice.threads != other.threads) {
                usage_error("--device lists threads twice, with different counts; keep one");
            }
            if (choice.use_threads ||
                (choice.device.index == other.device.index && choice.failure == other.failure)) {
                return;
            }
        }
        found.push_back(choice);
    }

    DeviceChoice find_one(const std::string& spec) {
        if (const auto choice = choose_without_opencl(spec)) {
            if (choice->threads > 0 && threads_ > 0 && choice->threads != threads_) {
                usage_error("--threads {} contradicts --device {}; keep one", threads_, spec);
            }
            return *choice;
        }
        const std::vector<ClDevice>& devices = listed();
        if (!failure_.empty() && !is_auto(spec) &&
            std::none_of(devices.begin(), devices.end(), test_for(spec))) {
            DeviceChoice unlisted;
            unlisted.device.name = "--device " + spec;
            unlisted.failure = unlisted.device.name + ": " + failure_;
            return unlisted;
        }
        DeviceChoice choice = choose_device(spec, devices, problems_);
        if (choice.use_threads && choice.note.empty() && !failure_.empty()) {
            choice.note = "rendering on threads: " + failure_;
        }
        return choice;
    }

    void add_usable(std::vector<DeviceChoice>& found) {
        for (const ClDevice& device : listed()) {
            if (!device.unusable.empty()) continue;
            DeviceChoice choice;
            choice.device = device;
            add(found, choice);
        }
    }

    const std::vector<ClDevice>& listed() {
        if (!devices_) {
            devices_ = list_cl_devices(problems_, &failure_);
            if (loaded_) loaded_();
        }
        return *devices_;
    }

    const int threads_;
    const std::function<void()> loaded_;
    std::optional<std::vector<ClDevice>> devices_;
    std::vector<std::string> problems_;
    std::string failure_;  ///< of the first driver that could not list its devices
};

/// GPUs before other accelerators; never CPUs: threads run the same kernels there.
DeviceChoice best_device(const std::vector<ClDevice>& devices) {
    DeviceChoice choice;
    choice.use_threads = true;
    for (const ClDevice& device : devices) {
        if (device.is_cpu) continue;
        if (!device.unusable.empty()) {
            choice.note = fmt::format("rendering on threads: {}: {}", device.name, device.unusable);
        } else if (choice.use_threads || (device.is_gpu && !choice.device.is_gpu)) {
            choice.use_threads = false;
            choice.device = device;
        }
    }
    if (!choice.use_threads) choice.note.clear();
    return choice;
}

}  // namespace

DeviceChoice threads_choice() {
    DeviceChoice choice;
    choice.use_threads = true;
    return choice;
}

bool names_threads(const std::string& spec, DeviceChoice& choice) {
    if (spec != "threads" && spec.rfind("threads:", 0) != 0) return false;
    choice.use_threads = true;
    if (spec == "threads") return true;
    const auto count = parse_number<int>(std::string_view(spec).substr(8));
    if (!count || *count < 1 || *count > most_threads_asked) {
        usage_error("device '{}': expected 1 to {} threads", spec, most_threads_asked);
    }
    choice.threads = *count;
    return true;
}

std::vector<std::string> specs_of(const std::string& list) {
    std::vector<std::string> specs;
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        specs.push_back(list.substr(at, end - at));
        at = end + 1;
    }
    if (specs.size() > 1 && std::find(specs.begin(), specs.end(), "") != specs.end()) {
        usage_error("device '{}': an item of the list is empty", list);
    }
    return specs;
}

bool needs_opencl(const std::string& list) {
    for (const std::string& spec : specs_of(list)) {
        if (spec == all_devices || !choose_without_opencl(spec)) return true;
    }
    return false;
}

bool is_auto(const std::string& spec) { return spec.empty() || spec == "auto"; }

std::optional<DeviceChoice> choose_without_opencl(const std::string& spec) {
    DeviceChoice choice;
    if (names_threads(spec, choice)) return choice;
    if (!is_auto(spec) || gpu_may_be_here()) return std::nullopt;
    choice.use_threads = true;
    return choice;
}

void check_device_list(const std::string& list) {
    for (const std::string& spec : specs_of(list)) {
        DeviceChoice ignored;
        if (spec != all_devices && !is_auto(spec) && !names_threads(spec, ignored)) test_for(spec);
    }
}

DeviceChoice choose_device(const std::string& spec, const std::vector<ClDevice>& devices,
                           const std::vector<std::string>& problems) {
    if (is_auto(spec)) return best_device(devices);
    std::vector<ClDevice> fitting;
    std::copy_if(devices.begin(), devices.end(), std::back_inserter(fitting), test_for(spec));
    if (fitting.empty()) {
        throw Error(ExitCode::device,
                    fmt::format("device '{}' matches no OpenCL device; available:{}", spec,
                                describe_all(devices, problems)));
    }
    if (fitting.size() > 1) {
        usage_error("device '{}' matches several devices; choose one by its index:{}", spec,
                    describe_all(fitting));
    }
    if (!fitting.front().unusable.empty()) {
        throw Error(ExitCode::device,
                    fmt::format("device {} ({}) cannot be used: {}", fitting.front().index,
                                fitting.front().name, fitting.front().unusable));
    }
    DeviceChoice choice;
    choice.device = fitting.front();
    return choice;
}

std::future<std::vector<DeviceChoice>> find_devices(const std::string& list, int threads,
                                                    const std::function<void()>& loaded) {
    const auto find = [=] { return DeviceFinder(threads, loaded).find(list); };
    if (needs_opencl(list)) {
        prepare_pocl(threads);
        try {
            return std::async(std::launch::async, find);
        } catch (const std::system_error&) {  // no thread available: search later
        }
    }
    return std::async(std::launch::deferred, find);
}

}  // namespace rt
