// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/files.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/base/version.h"
#include "host/cli/options.h"
#include "host/image/picture_io.h"
#include "host/measure/timing.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/pocl.h"
#include "host/picture/render_picture.h"
#include "host/process/drivers.h"
#include "host/record/record.h"
#include "host/render/native_kernels.h"
#include "host/scene/scene_file.h"
#include "host/view/viewer.h"

namespace rt {

namespace {

/// `mirrorball doctor`
struct DoctorOptions {
    std::string drivers;          ///< where OpenCL finds its .icd files
    std::string library_folders;  ///< LD_LIBRARY_PATH
    std::string device;           ///< empty: everything, each device in its own process
    double deadline = 30;         ///< seconds without progress before a device counts as hung
    bool json = false;
};

/// The paper's scene at 100 x 100, as every correct device renders it (tests/cli/doctor_cases.py).
constexpr PictureSize size{100, 100};
constexpr std::uint64_t float_hash = 0x303e5fab0252b3bc, double_hash = 0x77e0bc0cd7798ce4;

enum class State { fine, missing, broken };

constexpr Named<State> states[] = {
    {"ok", State::fine}, {"missing", State::missing}, {"broken", State::broken}};
constexpr auto& enum_names(State) { return states; }

struct Finding {
    State state = State::fine;
    std::string what;     ///< "device 0"
    std::string verdict;  ///< what is wrong, and what to do
};

template <typename A, Of<Finding> X>
void describe(A& a, X& x) {
    a("state", x.state, "");
    a("what", x.what, "");
    a("verdict", x.verdict, "");
}

/// Empty if the device renders the right picture. Throws what rendering throws.
std::string what_is_wrong(const DeviceChoice& device, Precision precision) {
    RenderSettings settings = timed_settings();
    settings.size = size;
    settings.precision = precision;
    Scene scene = load_default_scene();
    apply_overrides(scene, settings);
    static const StopFlag never_stopped{0};  // a stop signal ends this process at once
    const auto devices = [&] { return std::vector{device}; };
    const std::uint64_t hash =
        render_picture(scene, settings, devices, {}, never_stopped).stats.image_hash;
    if (hash == (precision == Precision::float64 ? double_hash : float_hash)) return "";
    return fmt::format("renders a wrong picture in {} (image {}); {}", to_string(precision),
                       hash_text(hash), advice_on_other_bits(device.is_exact(precision)));
}

/// Tests a device in this process, a worker.
int test_device(const std::string& spec) {
    watch_worker("testing " + spec);
    const DeviceChoice device = find_devices(spec, 0, {}).get().front();
    std::string wrong = what_is_wrong(device, Precision::float32);
    if (wrong.empty() && (device.use_threads || device.device.has_double)) {
        wrong = what_is_wrong(device, Precision::float64);
    }
    if (wrong.empty()) return 0;
    tell_parent(wrong);
    return static_cast<int>(ExitCode::different);
}

/// Tests a device in a worker process.
Finding test_in_worker(const DoctorOptions& options, const std::string& spec,
                       const std::string& name, const std::string& drivers) {
    const Stopwatch watch;
    std::vector<std::string> command{"mirrorball", "doctor", "--device", spec};
    const auto& [cl_options, folder] = build_extras();
    if (!cl_options.empty()) command.push_back("--cl-options=" + cl_options);
    if (!folder.empty()) command.push_back("--save-kernels=" + folder);
    const WorkerEnd end =
        run_worker({command, drivers, options.deadline, 0, 10 * options.deadline});
    end_if_stopped(end);
    Finding finding{State::broken, name, ""};
    if (!end.is_regular) {
        finding.verdict =
            "its test process " + end.how + (end.is_started ? "; update its driver" : "");
    } else if (end.status == 0) {
        finding.state = State::fine;
        finding.verdict = fmt::format("renders the right picture ({:.2f} s)", watch.seconds());
    } else if (!end.records.empty()) {
        finding.verdict = end.records.front();
    } else {
        finding.verdict = "cannot render (see above)";
    }
    return finding;
}

Finding test_format(const char* name, const char* extension) {
    const TemporaryFolder folder;
    try {
        check_picture_path(folder.name() + "/picture" + extension);
        return {State::fine, name, "can be written and read"};
    } catch (const Error& error) {
        const std::string text = error.what();
        const std::size_t colon = text.find(": ");
        return {State::missing, name, colon == text.npos ? text : text.substr(colon + 2)};
    }
}

Finding test_window() {
    const std::string why = why_no_windows();
    return {why.empty() ? State::fine : State::missing, "windows (--show)",
            why.empty() ? "SDL 2 can be loaded" : why};
}

Finding test_kernel_cache() {
    const std::string why = why_pocl_cache_is_read_only();
    if (!why.empty()) {
        return {State::broken, "kernel cache",
                "PoCL cannot write to it: " + why + "; set POCL_CACHE_DIR to a writable folder"};
    }
    if (!pocl_keeps_kernels()) {
        return {State::missing, "kernel cache",
                "PoCL recompiles its kernels in every run; unset POCL_KERNEL_CACHE"};
    }
    return {State::fine, "kernel cache",
            "PoCL caches compiled kernels in " + pocl_cache_folder().string()};
}

/// Of drivers, and of the devices that they list.
void examine_opencl(const DoctorOptions& options, std::vector<Finding>& findings) {
    const Drivers drivers = list_drivers(options.drivers, std::min(options.deadline, 10.0));
    for (const std::string& file : drivers.files) findings.push_back({State::fine, "driver", file});
    for (const std::string& problem : drivers.bad_files) {
        findings.push_back({State::broken, "driver", problem});
    }
    for (const std::string& library : unlisted_drivers(options.drivers, options.library_folders)) {
        findings.push_back(
            {State::missing, "driver",
             fmt::format("{}: no .icd file names it; put that name into {}/{}.icd", library,
                         options.drivers, std::filesystem::path(library).stem().stem().string())});
    }
    if (drivers.files.empty() && drivers.devices.empty()) {
        return findings.push_back(
            {State::missing, "OpenCL",
             "no driver in " + options.drivers + "; install pocl-opencl-icd or your GPU's driver"});
    }
    for (const std::string& problem : drivers.problems) {
        const bool is_idle = !drivers.devices.empty() && problem.find(no_devices) != problem.npos;
        findings.push_back({is_idle ? State::missing : State::broken, "OpenCL", problem});
    }
    for (const ClDevice& device : drivers.devices) {
        const std::string index = std::to_string(device.index);
        const std::string name = fmt::format("device {}, {}", index, device.name);
        findings.push_back(device.unusable.empty()
                               ? test_in_worker(options, index, name, drivers.place)
                               : Finding{State::broken, name, device.unusable});
    }
    findings.push_back(test_kernel_cache());
}

std::vector<Finding> examine(const DoctorOptions& options) {
    std::error_code error;
    if (!std::filesystem::exists("/proc/self/exe", error)) {
        return {{State::broken, "/proc",
                 "is not mounted, so the program finds neither itself nor its modules; mount it"}};
    }
    std::vector<Finding> findings;
    const std::vector<std::string> isas = native_isas();
    findings.push_back({isas.empty() ? State::broken : State::fine, "processor",
                        isas.empty() ? "has no kernels for pthreads; render on an OpenCL device"
                                     : fmt::format("kernels for {}", fmt::join(isas, ", "))});
    prepare_pocl(0);
    findings.push_back(test_in_worker(options, "threads", "threads", {}));
    examine_opencl(options, findings);
    findings.push_back(test_format("EXR pictures", ".exr"));
    findings.push_back(test_format("TIFF, JPEG and other pictures", ".tif"));
    findings.push_back(test_window());
    return findings;
}

std::string findings_text(const std::vector<Finding>& findings, bool is_well) {
    std::string text = fmt::format("mirrorball {} ({})\n", version, git_revision);
    for (const Finding& finding : findings) {
        text += fmt::format("{:<8} {}: {}\n", name_of(states, finding.state), finding.what,
                            finding.verdict);
    }
    return text + (is_well ? "everything installed works\n" : "something is broken\n");
}

std::string findings_json(const std::vector<Finding>& findings, bool is_well) {
    return json_text({{"format", "mirrorball-doctor"},
                      {"version", 1},
                      {"program", fmt::format("{} ({})", version, git_revision)},
                      {"well", is_well},
                      {"findings", json_of(findings)}});
}

int run_doctor(const DoctorOptions& options) {
    if (is_worker()) return test_device(options.device);
    const std::vector<Finding> findings =
        options.device.empty()
            ? examine(options)
            : std::vector{test_in_worker(options, options.device, options.device, {})};
    const bool is_well = std::ranges::count(findings, State::broken, &Finding::state) == 0;
    print_result(options.json ? findings_json(findings, is_well)
                              : findings_text(findings, is_well));
    return static_cast<int>(is_well ? ExitCode::done : ExitCode::device);
}

}  // namespace

void add_doctor(Verb& program, const Invocation& call) {
    const auto asked = std::make_shared<DoctorOptions>();
    DoctorOptions& doctor = *asked;
    Verb& verb = program.verb(
        "doctor",
        "check the installation (drivers, devices, caches, formats) and suggest how to fix it");
    doctor.library_folders = environment("LD_LIBRARY_PATH");
    verb.flag("--json", doctor.json, json_help);
    verb.value("--device", "SPEC", doctor.device, parse_device, "check only this device");
    verb.value("--deadline", "S", doctor.deadline, seconds_from(0.1),
               "seconds without progress after which a device counts as hung; its test may take "
               "ten times as long (default: 30)");
    add_build_extras(verb);
    doctor.drivers = call.drivers;
    verb.run = [asked] { return run_doctor(*asked); };
}

}  // namespace rt
