// SPDX-License-Identifier: Apache-2.0

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "host/image/picture_module.h"

namespace rt {
namespace {

/// One thread (more gain nothing here), and no messages on stderr.
void configure_once() {
    static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1) &&
                             OIIO::attribute("debug", 0);
    static_cast<void>(done);
}

[[noreturn]] void fail(const std::string& complaint, const char* otherwise) {
    throw std::runtime_error(complaint.empty() ? otherwise : complaint);
}

OIIO::ImageSpec make_spec(const EncodeRequest& request, OIIO::TypeDesc type) {
    const Picture& picture = request.picture;
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type);
    if (request.color_space != nullptr) spec.attribute("oiio:ColorSpace", request.color_space);
    if (type == OIIO::TypeFloat) spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // else TIFF is stamped with the time
    for (const auto& [name, text] : request.metadata) {
        if (!text.empty()) spec.attribute(name, text);
    }
    return spec;
}

std::vector<std::byte> encode(const EncodeRequest& request) {
    configure_once();
    const std::string format = request.format;
    const bool has_floats = request.bytes.empty();
    const OIIO::TypeDesc type = has_floats ? OIIO::TypeFloat : OIIO::TypeUInt8;
    const void* const pixels =
        has_floats ? static_cast<const void*>(request.picture.pixels.data()) : request.bytes.data();
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(OIIO::geterror(), "unknown reason");
    if (!output->set_ioproxy(&memory)) fail("", "this format cannot be written to memory");
    const bool written = output->open("memory." + format, make_spec(request, type)) &&
                         output->write_image(type, pixels);
    const bool closed = output->close();
    // A writer may return success and still report an error; ignores the one TIFF always reports.
    const std::string complaint = output->geterror();
    const bool is_idle = complaint == "failed TIFFWriteCustomDirectory() of the Exif data";
    if (!written || !closed || (!complaint.empty() && !is_idle)) fail(complaint, "unknown reason");
    const auto result = std::as_bytes(std::span(bytes));
    return {result.begin(), result.end()};
}

/// Rows [first, last) in the file's own type, for scanline and tiled files.
bool read_native(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int first, int last,
                 OIIO::TypeDesc type, void* values) {
    const int y = spec.y + first;
    const int end = spec.y + last;
    if (spec.tile_width == 0) {
        return input.read_scanlines(0, 0, y, end, 0, 0, spec.nchannels, type, values);
    }
    return input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, end, 0, 1, 0, spec.nchannels,
                            type, values);
}

template <typename Integer>
bool read_integers(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int first, int last,
                   std::span<float> values) {
    std::vector<Integer> native(values.size());
    const bool ok = read_native(input, spec, first, last, spec.format, native.data());
    constexpr float largest = std::numeric_limits<Integer>::max();
    std::transform(native.begin(), native.end(), values.begin(),
                   [](Integer value) { return static_cast<float>(value) / largest; });
    return ok;
}

/// The same rows as float: exactly v / 255 and v / 65535 for integers, untouched otherwise.
bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int first, int last,
               std::span<float> values) {
    if (spec.format == OIIO::TypeUInt8) {
        return read_integers<std::uint8_t>(input, spec, first, last, values);
    }
    if (spec.format == OIIO::TypeUInt16) {
        return read_integers<std::uint16_t>(input, spec, first, last, values);
    }
    return read_native(input, spec, first, last, OIIO::TypeFloat, values.data());
}

/// Reads a few rows at a time, so that a false header costs no memory for missing pixels.
void read_all_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec,
                   std::vector<float>& pixels) {
    const int step = spec.tile_width == 0 ? 64 : spec.tile_height;
    const std::size_t row = static_cast<std::size_t>(spec.width) * spec.nchannels;
    for (int first = 0; first < spec.height; first += step) {
        const int last = std::min(first + step, spec.height);
        const std::size_t start = pixels.size();
        pixels.resize(row * last);
        // Some readers report success and still leave an error: TIFF of a file cut short.
        if (!read_rows(input, spec, first, last, std::span(pixels).subspan(start)) ||
            input.has_error()) {
            fail(input.geterror(), "the pixels are damaged");
        }
        pixels.reserve(row * spec.height);  // address space only
    }
}

/// The library allocates whole tiles.
bool has_huge_tiles(const OIIO::ImageSpec& spec) {
    constexpr double usual = 1 << 20;
    const double pixels = static_cast<double>(spec.width) * spec.height;
    return static_cast<double>(spec.tile_width) * spec.tile_height > 4 * pixels + usual;
}

PictureFile decode(const std::string& path, const char* format, const CheckSize& check) {
    configure_once();
    const auto input = OIIO::ImageInput::create(format);
    if (!input) fail(OIIO::geterror(), "unknown reason");
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // values as stored, not multiplied by alpha
    OIIO::ImageSpec spec;
    if (!input->open(path, spec, config)) fail(input->geterror(), "the header is damaged");
    if (spec.depth > 1 || spec.deep) fail("", "not a flat picture");
    if (spec.get_int_attribute("Orientation", 1) != 1)
        fail("", "turned or mirrored; save it upright");
    if (has_huge_tiles(spec)) fail("", "its tiles are much larger than the picture");
    const bool wants_pixels = check(spec.width, spec.height, spec.nchannels);
    PictureFile file{{spec.width, spec.height, spec.nchannels, {}}, {}};
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        if (attribute.type() != OIIO::TypeString) continue;
        file.metadata.emplace_back(attribute.name().string(), attribute.get_string().c_str());
    }
    if (wants_pixels) read_all_rows(*input, spec, file.picture.pixels);
    return file;
}

}  // namespace
}  // namespace rt

extern "C" [[gnu::visibility("default")]] const void* mirrorball_module() {
    static constexpr rt::PictureModule module{rt::PictureModule::current_version, rt::encode,
                                              rt::decode};
    return &module;
}
