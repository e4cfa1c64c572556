// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "host/image/image_error.h"
#include "host/opencl/cl_renderer.h"
#include "host/render/film.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene.h"

namespace rt::test {

/// Every scene file in scenes/ or a folder there, sorted, without those in its subfolders.
std::vector<std::filesystem::path> scene_files(const std::string& folder = "");

/// For tests that are named by their scene.
std::string scene_name(const testing::TestParamInfo<std::filesystem::path>& info);

/// A scene from scenes/ by its stem, such as "cornell-box".
Scene load_named_scene(const std::string& stem);

/// The device under test: the one MIRRORBALL_TEST_DEVICE names (as --device does), else PoCL's,
/// else the first. Tests that use it fail if there is none.
const ClDevice& test_device();

/// Renders whole pictures. A tile of 0 x 0: the renderer's default.
template <typename T>
Film<T> render_on_threads(const Scene& scene, const ThreadsOptions& options = {}, Rect tile = {});

template <typename T>
Film<T> render_on_device(const Scene& scene, const ClOptions& options = {}, Rect tile = {});

ClOptions cl_options(Launch launch, bool all_features = false);

/// `film` against `reference`, both clamped to [0, 1].
template <typename A, typename B>
ImageError film_error(const Film<A>& film, const Film<B>& reference);

}  // namespace rt::test
