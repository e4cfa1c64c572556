// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/kept_programs.h"

#include <map>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "host/opencl/cl_program.h"

namespace rt {

namespace {

using Binary = std::vector<unsigned char>;
using Key = std::tuple<cl_device_id, std::string, std::string>;

std::mutex mutex;
std::map<Key, Binary> binaries;

Key key_of(const ClDevice& device, const char* source, const std::string& options) {
    return {device.handle, source, options};
}

Binary find_binary(const Key& key) {
    const std::lock_guard lock(mutex);
    const auto found = binaries.find(key);
    return found == binaries.end() ? Binary{} : found->second;
}

}  // namespace

std::optional<cl::Program> kept_program(const cl::Context& context, const ClDevice& device,
                                        const char* source, const std::string& options) {
    const Key key = key_of(device, source, options);
    const Binary binary = find_binary(key);
    if (binary.empty()) return std::nullopt;
    try {
        const cl::Device handle = handle_of(device);
        cl::Program program(context, {handle}, {binary});
        program.build({handle}, options.c_str());
        return program;
    } catch (const cl::Error&) {
        const std::lock_guard lock(mutex);
        binaries.erase(key);
        return std::nullopt;
    }
}

void keep_program(const cl::Program& program, const ClDevice& device, const char* source,
                  const std::string& options) {
    if (!device.is_cpu || device.platform == pocl_platform) return;
    try {
        std::vector<Binary> built = program.getInfo<CL_PROGRAM_BINARIES>();
        if (built.size() != 1 || built[0].empty()) return;
        const std::lock_guard lock(mutex);
        binaries.insert_or_assign(key_of(device, source, options), std::move(built[0]));
    } catch (const cl::Error&) {
        // It works without.
    }
}

}  // namespace rt
