// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/named.h"
#include "host/base/temporary_folder.h"
#include "host/base/version.h"
#include "host/image/picture_io.h"
#include "host/mpi/ranks.h"
#include "host/opencl/icd_files.h"
#include "host/picture/render_picture.h"
#include "host/pocl/pocl_cache.h"
#include "host/pocl/pocl_environment.h"
#include "host/print/print_stats.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/render/native_kernels.h"
#include "host/render/stopwatch.h"
#include "host/verbs/default_scene.h"
#include "host/verbs/verbs.h"
#include "host/view/sdl.h"

namespace rt {

namespace {

/// The paper's scene at 100 x 100, as every correct device renders it (tests/cli/doctor_cases.py).
constexpr PictureSize size{100, 100};
constexpr std::uint64_t float_hash = 0x303e5fab0252b3bc, double_hash = 0x668173dac9fdc30f;

/// How many deadlines testing a device, which may be busy for ever, may take.
constexpr double longest_test = 10;

enum class State { fine, missing, broken };

constexpr Named<State> state_words[] = {
    {"ok", State::fine}, {"missing", State::missing}, {"BROKEN", State::broken}};

struct Finding {
    State state = State::fine;
    std::string what;     ///< "device 0"
    std::string verdict;  ///< what is wrong, and what to do
};

/// Throws Error: ExitCode::different if the bits are wrong, else what rendering throws.
void render_known_picture(const DeviceChoice& device, Precision precision) {
    RenderSettings settings;
    settings.size = size;
    settings.precision = precision;
    settings.no_fallback = true;
    settings.self_test = false;
    Scene scene = load_default_scene();
    apply_overrides(scene, settings);
    static const StopFlag never_stopped{0};
    const RenderedPicture rendered = render_picture(scene, settings, {device}, {}, never_stopped);
    const bool is_double = precision == Precision::float64;
    if (rendered.stats.image_hash == (is_double ? double_hash : float_hash)) return;
    throw Error(ExitCode::different,
                fmt::format("renders a wrong picture in {} (image {})", precision_name(is_double),
                            hash_text(rendered.stats.image_hash)));
}

/// Tests a device in this process.
int test_device(const std::string& spec) {
    watch_worker(true);
    const DeviceChoice device = find_devices(spec, 0, {}).get().front();
    render_known_picture(device, Precision::float32);
    if (device.use_threads || device.device.has_double) {
        render_known_picture(device, Precision::float64);
    }
    return 0;
}

/// Tests a device in a worker process.
Finding test_in_worker(const DoctorOptions& options, const std::string& spec,
                       const std::string& name, const std::vector<std::string>& changes) {
    const Stopwatch watch;
    const WorkerEnd end = run_worker({options.command.front(), "doctor", "--device", spec}, changes,
                                     options.deadline, 0, longest_test * options.deadline);
    const int stop = end.is_regular ? end.status - 128 : end.stop_signal;
    if (stop > 0) end_by_stop_signal(stop);
    Finding finding{State::broken, name, ""};
    if (!end.is_regular) {
        finding.verdict = "its test process " + end.how + "; update its driver";
    } else if (end.status == 0) {
        finding.state = State::fine;
        finding.verdict = fmt::format("renders the right picture ({:.2f} s)", watch.seconds());
    } else if (end.status == static_cast<int>(ExitCode::different)) {
        finding.verdict =
            "renders a wrong picture (see above); clear its kernel cache or update its "
            "driver";
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
    std::string why;
    const bool is_there = sdl::load(why) != nullptr;
    return {is_there ? State::fine : State::missing, "windows (--show)",
            is_there ? "SDL 2 can be loaded" : why};
}

Finding test_mpi() {
    try {
        check_mpi();
        return {State::fine, "MPI (--mpi)", "can be loaded"};
    } catch (const Error& error) {
        return {State::missing, "MPI (--mpi)", error.what()};
    }
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

void examine_devices(const DoctorOptions& options, IcdFiles& files,
                     std::vector<Finding>& findings) {
    const UsableIcdFiles usable(files);
    for (const ClDevice& device : list_devices_of(files, usable)) {
        const std::string name = fmt::format("device {}, {}", device.index, device.name);
        std::vector<std::string> changes;
        if (!device.icd_file.empty()) changes.push_back("OCL_ICD_VENDORS=" + device.icd_file);
        findings.push_back(
            device.unusable.empty()
                ? test_in_worker(options, std::to_string(device.index), name, changes)
                : Finding{State::broken, name, device.unusable});
    }
    for (const std::string& problem : files.problems) {
        findings.push_back({State::broken, "OpenCL", problem});
    }
    findings.push_back(test_kernel_cache());
}

std::vector<Finding> examine(const DoctorOptions& options) {
    std::vector<Finding> findings;
    const std::vector<std::string> isas = native_isas();
    findings.push_back({isas.empty() ? State::broken : State::fine, "processor",
                        isas.empty() ? "has no kernels for pthreads; render on an OpenCL device"
                                     : fmt::format("kernels for {}", fmt::join(isas, ", "))});
    prepare_pocl(0);
    IcdFiles files = try_icd_files(options.drivers);
    for (const std::string& file : files.usable) {
        findings.push_back({State::fine, "driver", file});
    }
    for (const std::string& problem : files.problems) {
        findings.push_back({State::broken, "driver", problem});
    }
    if (files.usable.empty()) {
        findings.push_back(
            {State::missing, "OpenCL",
             "no driver in " + options.drivers + "; install pocl-opencl-icd or your GPU's driver"});
    }
    files.problems.clear();
    findings.push_back(test_in_worker(options, "threads", "threads", {}));
    if (!files.usable.empty()) examine_devices(options, files, findings);
    findings.push_back(test_format("EXR pictures", ".exr"));
    findings.push_back(test_format("TIFF, JPEG and other pictures", ".tif"));
    findings.push_back(test_window());
    findings.push_back(test_mpi());
    return findings;
}

void print_findings(const std::vector<Finding>& findings, bool is_well) {
    std::string text = fmt::format("mirrorball {} ({})\n", version, git_revision);
    for (const Finding& finding : findings) {
        text += fmt::format("{:<8} {}: {}\n", name_of(state_words, finding.state), finding.what,
                            finding.verdict);
    }
    print_result(text + (is_well ? "everything installed works\n" : "something is broken\n"));
}

void print_findings_json(const std::vector<Finding>& findings, bool is_well) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Finding& finding : findings) {
        list.push_back(
            {{"state",
              finding.state == State::broken ? "broken" : name_of(state_words, finding.state)},
             {"what", finding.what},
             {"verdict", finding.verdict}});
    }
    print_result(json_text({{"format", "mirrorball-doctor"},
                            {"version", 1},
                            {"program", fmt::format("{} ({})", version, git_revision)},
                            {"well", is_well},
                            {"findings", list}}));
}

}  // namespace

int run_doctor(const DoctorOptions& options) {
    if (!options.device.empty()) return test_device(options.device);
    const std::vector<Finding> findings = examine(options);
    bool is_well = true;
    for (const Finding& finding : findings) is_well &= finding.state != State::broken;
    if (options.json) {
        print_findings_json(findings, is_well);
    } else {
        print_findings(findings, is_well);
    }
    return static_cast<int>(is_well ? ExitCode::done : ExitCode::device);
}

}  // namespace rt
