// SPDX-License-Identifier: Apache-2.0
#include "tests/render_helpers.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "host/flatten/flat_scene.h"
#include "host/opencl/devices.h"
#include "host/opencl/opencl.h"
#include "host/scene/scene_file.h"
#include "tests/whole_film.h"

namespace rt::test {

namespace {

ClDevice find_test_device() {
    const ClDeviceList list = list_cl_devices();
    if (const char* spec = std::getenv("MIRRORBALL_TEST_DEVICE")) {
        return choose_device(spec, list).device;
    }
    for (const ClDevice& device : list.devices) {
        if (device.platform == "Portable Computing Language") return device;
    }
    if (list.devices.empty()) throw std::runtime_error("no OpenCL device to test");
    return list.devices.front();
}

/// Contexts and programs for the whole test run, never destroyed: drivers may unload first.
const std::shared_ptr<OpenDevices>& open_devices() {
    static const auto& devices = *new std::shared_ptr<OpenDevices>(make_open_devices());
    return devices;
}

template <typename T>
Picture clamped(const Film<T>& film) {
    Picture picture;
    picture.width = film.width;
    picture.height = film.height;
    for (const T value : film.rgb) {
        picture.pixels.push_back(static_cast<float>(std::clamp<T>(value, 0, 1)));
    }
    return picture;
}

}  // namespace

std::vector<std::filesystem::path> scene_files(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path scenes(MIRRORBALL_SCENES_DIR);
    for (const auto& entry : std::filesystem::directory_iterator(scenes / folder)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".json") && !name.ends_with(".schema.json") && name != "golden.json") {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string scene_name(const testing::TestParamInfo<std::filesystem::path>& info) {
    std::string name = info.param.stem().string();
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

Scene load_named_scene(const std::string& stem) {
    return load_scene(std::string(MIRRORBALL_SCENES_DIR) + "/" + stem + ".json");
}

const ClDevice& test_device() {
    static const ClDevice device = find_test_device();
    return device;
}

template <typename T>
Film<T> render_on_threads(const Scene& scene, const ThreadsOptions& options, Rect tile) {
    const FlatScene<T> flat = flatten<T>(scene);
    return whole_film(*make_threads_renderer(flat, options), scene.width, scene.height, tile);
}

template <typename T>
Film<T> render_on_device(const Scene& scene, const ClOptions& options, Rect tile) {
    const FlatScene<T> flat = flatten<T>(scene);
    ClOptions for_scene = options;
    for_scene.open_devices = open_devices();
    return whole_film(*make_cl_renderer(flat, test_device(), for_scene), scene.width, scene.height,
                      tile);
}

ClOptions cl_options(Launch launch, bool all_features) {
    ClOptions options;
    options.kernels.launch = launch;
    if (all_features) options.kernels.features = every_feature;
    return options;
}

template <typename A, typename B>
ImageError film_error(const Film<A>& film, const Film<B>& reference) {
    return image_error(clamped(film), clamped(reference));
}

template Film<float> render_on_threads(const Scene&, const ThreadsOptions&, Rect);
template Film<double> render_on_threads(const Scene&, const ThreadsOptions&, Rect);
template Film<float> render_on_device(const Scene&, const ClOptions&, Rect);
template Film<double> render_on_device(const Scene&, const ClOptions&, Rect);
template ImageError film_error(const Film<float>&, const Film<double>&);
template ImageError film_error(const Film<float>&, const Film<float>&);
template ImageError film_error(const Film<double>&, const Film<double>&);

}  // namespace rt::test
