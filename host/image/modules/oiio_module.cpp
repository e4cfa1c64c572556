// SPDX-License-Identifier: Apache-2.0

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/image/module_guard.h"

namespace rt::module {
namespace {

/// One thread (more gain nothing here), and no messages on stderr.
void configure_once() {
    static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1) &&
                             OIIO::attribute("debug", 0);
    static_cast<void>(done);
}

OIIO::ImageSpec make_spec(const EncodeRequest& request, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(request.width, request.height, request.channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    if (request.color_space != nullptr) spec.attribute("oiio:ColorSpace", request.color_space);
    if (type == OIIO::TypeFloat) spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // else TIFF is stamped with the time
    for (std::size_t i = 0; i < request.attribute_count; ++i) {
        spec.attribute(request.attribute_names[i], request.attribute_texts[i]);
    }
    return spec;
}

int encode_picture(const EncodeRequest& request, const ByteSink& sink, ErrorText error) {
    configure_once();
    const std::string format = request.format;
    const OIIO::TypeDesc type = request.is_float != 0 ? OIIO::TypeFloat : OIIO::TypeUInt8;
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) return fail(error, OIIO::geterror());
    if (!output->set_ioproxy(&memory)) return fail(error, "no writing to memory in this format");
    const bool written = output->open("memory." + format, make_spec(request, type)) &&
                         output->write_image(type, request.pixels);
    const bool closed = output->close();
    // A writer may return success and still report an error; ignores the one TIFF always reports.
    const std::string complaint = output->geterror();
    const bool is_idle = complaint == "failed TIFFWriteCustomDirectory() of the Exif data";
    if (!written || !closed || (!complaint.empty() && !is_idle)) {
        return fail(error, complaint.empty() ? "unknown reason" : complaint);
    }
    return sink.write(sink.context, 0, bytes.data(), bytes.size());
}

template <typename Integer>
void widen(const std::vector<Integer>& from, std::vector<float>& to, float largest) {
    to.resize(from.size());
    std::transform(from.begin(), from.end(), to.begin(),
                   [largest](Integer value) { return static_cast<float>(value) / largest; });
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

/// The same rows as float: exactly v / 255 and v / 65535 for integers, untouched otherwise.
bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, int first, int last,
               std::vector<float>& values) {
    const std::size_t count = static_cast<std::size_t>(spec.width) * spec.nchannels *
                              static_cast<std::size_t>(last - first);
    if (spec.format == OIIO::TypeUInt8) {
        std::vector<unsigned char> native(count);
        const bool ok = read_native(input, spec, first, last, spec.format, native.data());
        widen(native, values, 255.0f);
        return ok;
    }
    if (spec.format == OIIO::TypeUInt16) {
        std::vector<unsigned short> native(count);
        const bool ok = read_native(input, spec, first, last, spec.format, native.data());
        widen(native, values, 65535.0f);
        return ok;
    }
    values.resize(count);
    return read_native(input, spec, first, last, OIIO::TypeFloat, values.data());
}

int read_all_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const PictureSink& sink,
                  ErrorText error) {
    // Reads a few rows at a time, so that a false header costs no memory for missing pixels.
    const int step = spec.tile_width == 0 ? 64 : spec.tile_height;
    std::vector<float> values;
    for (int first = 0; first < spec.height; first += step) {
        const int last = std::min(first + step, spec.height);
        // Some readers report success and still leave an error: TIFF of a file cut short.
        if (!read_rows(input, spec, first, last, values) || input.has_error()) {
            const std::string complaint = input.geterror();
            return fail(error, complaint.empty() ? "the pixels are damaged" : complaint);
        }
        if (sink.rows(sink.context, values.data(), values.size()) == 0) return 0;
    }
    return 1;
}

/// The library allocates whole tiles.
bool has_huge_tiles(const OIIO::ImageSpec& spec) {
    constexpr double usual = 1 << 20;
    const double pixels = static_cast<double>(spec.width) * spec.height;
    return static_cast<double>(spec.tile_width) * spec.tile_height > 4 * pixels + usual;
}

int decode_picture(const char* path, const char* format, const PictureSink& sink, ErrorText error) {
    configure_once();
    const auto input = OIIO::ImageInput::create(format);
    if (!input) return fail(error, OIIO::geterror());
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // values as stored, not multiplied by alpha
    OIIO::ImageSpec spec;
    if (!input->open(path, spec, config)) {
        const std::string complaint = input->geterror();
        return fail(error, complaint.empty() ? "the header is damaged" : complaint);
    }
    if (spec.depth > 1 || spec.deep) return fail(error, "not a flat picture");
    if (has_huge_tiles(spec)) return fail(error, "its tiles are much larger than the picture");
    if (sink.header(sink.context, spec.width, spec.height, spec.nchannels) == 0) return 0;
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        if (attribute.type() != OIIO::TypeString) continue;
        const std::string name = attribute.name().string();
        const std::string text = attribute.get_string();
        if (sink.attribute(sink.context, name.c_str(), text.c_str()) == 0) return 0;
    }
    if (sink.rows == nullptr) return 1;
    return read_all_rows(*input, spec, sink, error);
}

int encode(const EncodeRequest* request, const ByteSink* sink, ErrorText error) {
    return guarded(error, [&] { return encode_picture(*request, *sink, error); });
}

int decode(const char* path, const char* format, const PictureSink* sink, ErrorText error) {
    return guarded(error, [&] { return decode_picture(path, format, *sink, error); });
}

}  // namespace
}  // namespace rt::module

extern "C" __attribute__((visibility("default"))) const void* mirrorball_picture_module() {
    static constexpr rt::module::Module module{rt::module::interface_version, rt::module::encode,
                                               rt::module::decode};
    return &module;
}
