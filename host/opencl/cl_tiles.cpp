// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "host/opencl/cl_renderer.h"
#include "host/render/tile_rounds.h"

namespace rt {

namespace {

/// One work group of 64 less than 64 K.
constexpr std::size_t cpu_items = 65536 - 64;
constexpr std::size_t gpu_items = 1u << 20;

/// Samples per tile: what an interrupt may lose, and the unit that launches are made of.
constexpr std::size_t tile_samples = 1u << 14;

}  // namespace

std::size_t most_items(const ClDevice& device) { return device.is_cpu() ? cpu_items : gpu_items; }

bool launches_samples(Launch launch, const ClDevice& device, bool in_rounds) {
    if (in_rounds) return false;
    return launch == Launch::sample || (launch == Launch::automatic && !device.is_cpu());
}

template <typename T>
int packet_lanes(int asked_for, const ClDevice& device) {
    if (asked_for != 0) return asked_for;
    if (!device.is_cpu()) return 1;
    const unsigned native = sizeof(T) == sizeof(float) ? device.float_lanes : device.double_lanes;
    return static_cast<int>(std::bit_floor(std::clamp(native, 1u, 16u)));
}

template int packet_lanes<float>(int, const ClDevice&);
template int packet_lanes<double>(int, const ClDevice&);

template <typename T>
TileSizes cl_tile_sizes(const typename Flat<T>::LaunchParams& params, const ClDevice& device,
                        const ClOptions& options, int film_width) {
    const auto samples = static_cast<std::size_t>(params.samples);
    const PacketShape block =
        packet_shape(packet_lanes<T>(options.kernels.lanes, device), static_cast<int>(samples));
    const auto blocks = static_cast<int>(std::max<std::size_t>(
        tile_samples / (samples * static_cast<std::size_t>(block.pixels())), 1));
    const int across = (film_width + block.width - 1) / block.width;
    const int width = std::min(film_width, std::min(across, blocks) * block.width);
    // A tile has no more packets than pixels, whatever its shape.
    const bool in_rounds = renders_in_rounds(params);
    std::size_t most = most_items(device);
    if (launches_samples(options.kernels.launch, device, in_rounds)) most /= samples;
    if (in_rounds) most /= 12;  // with its margin, the narrowest tile has 11 times its pixels
    return {{0, 0, width, std::max(blocks / across, 1) * block.height},
            static_cast<std::int64_t>(most)};
}

template TileSizes cl_tile_sizes<float>(const Flat<float>::LaunchParams&, const ClDevice&,
                                        const ClOptions&, int);
template TileSizes cl_tile_sizes<double>(const Flat<double>::LaunchParams&, const ClDevice&,
                                         const ClOptions&, int);

}  // namespace rt
