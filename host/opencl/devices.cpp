// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/opencl/opencl.h"

namespace rt {

namespace {

/// Device strings may have padding and a trailing zero, and are not to be trusted.
std::string trimmed(const std::string& text) {
    const char* blanks = " \t\n\r";
    const std::string whole(text.c_str());
    const auto first = whole.find_first_not_of(blanks);
    if (first == std::string::npos) return "";
    return printable(whole.substr(first, whole.find_last_not_of(blanks) - first + 1));
}

std::string why_unusable(const cl::Device& device, const std::string& version) {
    if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "its driver reports it as unavailable";
    if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "its driver has no compiler";
    const bool is_old = version.starts_with("OpenCL 1.0") || version.starts_with("OpenCL 1.1");
    if (is_old) return version + "; OpenCL 1.2 is required";
    return "";
}

void describe_arithmetic(const cl::Device& device, ClDevice& described) {
    const auto single = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    described.rounds_correctly = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    described.keeps_subnormals = (single & CL_FP_DENORM) != 0;
    described.has_double =
        device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
    described.float_lanes = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    described.double_lanes =
        described.has_double ? device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE>() : 0;
}

ClDevice describe(const cl::Device& device) {
    ClDevice described;
    described.handle = device();
    described.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    described.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    described.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    described.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
    described.kind = (type & CL_DEVICE_TYPE_GPU) != 0   ? "GPU"
                     : (type & CL_DEVICE_TYPE_CPU) != 0 ? "CPU"
                                                        : "accelerator";
    described.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    described.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    described.max_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    describe_arithmetic(device, described);
    described.unusable = why_unusable(device, described.version);
    return described;
}

/// PoCL hides its device when it cannot write its kernel cache.
std::string why_no_device(const std::string& platform) {
    return fmt::format("OpenCL platform '{}'{}{}", platform, no_devices,
                       platform == pocl_platform
                           ? "check that its kernel cache can be written (POCL_CACHE_DIR, else "
                             "~/.cache/mirrorball), and check POCL_DEVICES"
                           : "check its driver");
}

void list_platform(const cl::Platform& platform, int platform_index, ClDeviceList& list) {
    std::string name = std::to_string(platform_index);
    try {
        name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        std::vector<cl::Device> devices;
        platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        if (devices.empty()) list.problems.push_back(why_no_device(name));
        int device_index = 0;
        for (const cl::Device& device : devices) {
            ClDevice described = describe(device);
            described.platform = name;
            described.index = static_cast<int>(list.devices.size());
            described.platform_index = platform_index;
            described.device_index = device_index++;
            list.devices.push_back(std::move(described));
        }
    } catch (const cl::Error& error) {
        list.problems.push_back(
            fmt::format("OpenCL platform '{}' cannot list its devices: {}; check its driver", name,
                        cl_status_text(error.err())));
        if (list.failure.empty()) list.failure = list.problems.back();
    }
}

}  // namespace

ClDeviceList list_cl_devices() {
    ClDeviceList list;
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& error) {
        const std::string text = fmt::format(
            "no OpenCL platform: {}; install pocl-opencl-icd or a GPU "
            "driver with OpenCL",
            cl_status_text(error.err()));
        if (error.err() != CL_PLATFORM_NOT_FOUND_KHR) list.failure = text;
        list.problems.push_back(text);
    }
    for (std::size_t i = 0; i < platforms.size(); ++i) {
        list_platform(platforms[i], static_cast<int>(i), list);
    }
    return list;
}

namespace {

using Kind = DeviceSpec::Kind;

constexpr Named<Kind> words[] = {{"", Kind::automatic}, {"auto", Kind::automatic},
                                 {"all", Kind::all},    {"threads", Kind::threads},
                                 {"cpu", Kind::cpu},    {"gpu", Kind::gpu},
                                 {"pocl", Kind::pocl}};

DeviceSpec parse_spec(const std::string& text) {
    DeviceSpec spec{.text = text};
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string head = text.substr(0, colon);
    const std::string tail = text.substr(std::min(colon + 1, text.size()));
    const auto first = parse_number<int>(head), second = parse_number<int>(tail);
    if (const auto kind = value_of(words, text)) {
        spec.kind = *kind;
    } else if (head == "threads") {
        spec.kind = Kind::threads;
        spec.threads = second.value_or(0);
        if (spec.threads < 1 || spec.threads > DeviceSpec::most_threads) {
            usage_error("device '{}': expected 1 to {} threads", text, DeviceSpec::most_threads);
        }
    } else if (head == "name" && !tail.empty()) {
        spec.kind = Kind::name;
        spec.name = lower(tail);
    } else if (head == text && first && *first >= 0) {
        spec.kind = Kind::index;
        spec.index = *first;
    } else if (first && second && *first >= 0 && *second >= 0) {
        spec.kind = Kind::place;
        spec.platform = *first;
        spec.index = *second;
    } else {
        usage_error(
            "device '{}': expected an index, platform:device, pocl, name:TEXT, cpu, gpu, "
            "threads[:N], all or auto, or several of them separated by commas",
            text);
    }
    return spec;
}

/// Whether OpenCL must be loaded.
bool needs_opencl(const DeviceSpec& spec) {
    return spec.kind == Kind::automatic ? gpu_may_be_here() : spec.kind != Kind::threads;
}

std::string describe_all(const ClDeviceList& list) {
    std::string text;
    if (list.devices.empty() && !list.problems.empty())
        return " none (" + list.problems.front() + "); see 'mirrorball devices'";
    for (const ClDevice& device : list.devices) {
        text += fmt::format("\n  {}  {} ({})", device.index, device.name, device.platform);
    }
    return text.empty() ? " none (see 'mirrorball devices')" : text;
}

/// GPUs before other accelerators; never CPUs: threads run the same kernels there.
DeviceChoice best_device(const std::vector<ClDevice>& devices) {
    DeviceChoice choice = threads_choice();
    for (const ClDevice& device : devices) {
        if (device.is_cpu()) continue;
        if (!device.unusable.empty()) {
            choice.note = fmt::format("rendering on threads: {}: {}", device.name, device.unusable);
        } else if (choice.use_threads || (device.is_gpu() && !choice.device.is_gpu())) {
            choice.use_threads = false;
            choice.device = device;
        }
    }
    if (!choice.use_threads) choice.note.clear();
    return choice;
}

/// Resolves a list of specs, listing devices at most once.
class DeviceFinder {
   public:
    DeviceFinder(int threads, const std::function<void()>& loaded)
        : threads_(threads), loaded_(loaded) {}

    std::vector<DeviceChoice> find(const std::string& list) {
        for (const DeviceSpec& spec : parse_device_specs(list)) {
            if (spec.kind == Kind::all) {
                add(threads_choice());
                for (const ClDevice& device : listed().devices) {
                    if (device.unusable.empty()) add({.device = device});
                }
                continue;
            }
            const DeviceChoice choice = find_one(spec);
            add(choice);
            // Threads trace while the automatically chosen device still compiles.
            if (spec.kind == Kind::automatic && !choice.use_threads) {
                add({.use_threads = true, .is_helper = true});
            }
        }
        return std::move(found_);
    }

   private:
    /// Each device once, by however many names.
    void add(const DeviceChoice& choice) {
        for (const DeviceChoice& other : found_) {
            if (choice.use_threads != other.use_threads) continue;
            if (choice.use_threads && choice.threads != other.threads) {
                usage_error("--device lists threads twice, with different counts; keep one");
            }
            if (choice.use_threads ||
                (choice.device.index == other.device.index && choice.failure == other.failure)) {
                return;
            }
        }
        found_.push_back(choice);
    }

    DeviceChoice find_one(const DeviceSpec& spec) {
        if (spec.threads > 0 && threads_ > 0 && spec.threads != threads_) {
            usage_error("--threads {} contradicts --device {}; keep one", threads_, spec.text);
        }
        if (!needs_opencl(spec)) return threads_choice(spec.threads);
        const ClDeviceList& all = listed();
        const auto fits = [&](const ClDevice& device) { return spec.fits(device); };
        if (!all.failure.empty() && spec.kind != Kind::automatic &&
            std::ranges::none_of(all.devices, fits)) {
            DeviceChoice unlisted;
            unlisted.device.name = "--device " + spec.text;
            unlisted.failure = unlisted.device.name + ": " + all.failure;
            return unlisted;
        }
        DeviceChoice choice = choose_device(spec.text, all);
        if (choice.use_threads && choice.note.empty() && !all.failure.empty()) {
            choice.note = "rendering on threads: " + all.failure;
        }
        return choice;
    }

    const ClDeviceList& listed() {
        if (!listed_) {
            listed_ = list_cl_devices();
            if (loaded_) loaded_();
        }
        return *listed_;
    }

    const int threads_;
    const std::function<void()> loaded_;
    std::vector<DeviceChoice> found_;
    std::optional<ClDeviceList> listed_;
};

/// Whether a name in the folder begins with one of these.
bool has_entry(const std::filesystem::path& folder, const std::vector<const char*>& prefixes) {
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    return !error && std::any_of(begin(entry), end(entry), [&](const auto& file) {
        const std::string name = file.path().filename();
        return std::any_of(prefixes.begin(), prefixes.end(),
                           [&](const char* prefix) { return name.starts_with(prefix); });
    });
}

}  // namespace

bool DeviceSpec::fits(const ClDevice& device) const {
    const std::string names = lower(device.name + "\n" + device.platform + "\n" + device.vendor);
    return (kind == Kind::cpu && device.is_cpu()) || (kind == Kind::gpu && device.is_gpu()) ||
           (kind == Kind::pocl && device.platform == pocl_platform) ||
           (kind == Kind::name && names.find(name) != std::string::npos) ||
           (kind == Kind::index && device.index == index) ||
           (kind == Kind::place && device.platform_index == platform &&
            device.device_index == index);
}

std::vector<DeviceSpec> parse_device_specs(const std::string& list) {
    std::vector<DeviceSpec> specs;
    for (const std::string& item : split(list, ',')) {
        if (item.empty() && !list.empty()) {
            usage_error("device '{}': an item of the list is empty", list);
        }
        specs.push_back(parse_spec(item));
    }
    return specs;
}

std::string DeviceChoice::spec() const {
    if (!use_threads) return std::to_string(device.index);
    return threads > 0 ? fmt::format("threads:{}", threads) : "threads";
}

DeviceChoice threads_choice(int threads) { return {.use_threads = true, .threads = threads}; }

bool needs_opencl(const std::string& list) {
    return std::ranges::any_of(parse_device_specs(list),
                               [](const DeviceSpec& spec) { return needs_opencl(spec); });
}

bool gpu_may_be_here(const std::string& folder) {
    const std::filesystem::path dev(folder);
    return has_entry(dev, {"nvidia", "kfd", "dxg", "mali", "pvr"}) ||
           has_entry(dev / "dri", {"renderD"}) || has_entry(dev / "accel", {"accel"});
}

DeviceChoice choose_device(const std::string& text, const ClDeviceList& list) {
    const DeviceSpec spec = parse_spec(text);
    if (spec.kind == Kind::automatic) return best_device(list.devices);
    std::vector<ClDevice> fitting;
    std::ranges::copy_if(list.devices, std::back_inserter(fitting),
                         [&](const ClDevice& device) { return spec.fits(device); });
    if (fitting.empty()) {
        throw Error(ExitCode::device,
                    fmt::format("device '{}' matches no OpenCL device; available:{}", text,
                                describe_all(list)));
    }
    if (fitting.size() > 1) {
        usage_error("device '{}' matches several devices; choose one by its index:{}", text,
                    describe_all({fitting}));
    }
    const ClDevice& device = fitting.front();
    if (!device.unusable.empty()) {
        throw Error(ExitCode::device, fmt::format("device {} ({}) cannot be used: {}", device.index,
                                                  device.name, device.unusable));
    }
    return {.device = device};
}

std::future<std::vector<DeviceChoice>> find_devices(const std::string& list, int threads,
                                                    const std::function<void()>& loaded) {
    const auto find = [=] { return DeviceFinder(threads, loaded).find(list); };
    if (!needs_opencl(list)) return std::async(std::launch::deferred, find);
    prepare_pocl(threads);
    return std::async(find);  // deferred where no thread can start
}

}  // namespace rt
