// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/stress_pictures.h"

#include <algorithm>

#include "host/image/picture_io.h"
#include "host/measure/heatmap.h"
#include "host/measure/picture_judge.h"

namespace rt {

namespace {

/// The text as part of a file name: '/', '^' and blanks become '-'.
std::string file_stem(const std::string& text) {
    std::string name = text;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '/' || c == '^' || c == ' '; }, '-');
    return name;
}

}  // namespace

StressPictures::StressPictures(const std::string& folder, const std::string& family,
                               const std::string& label, const ReferencePicture* reference)
    : reference_(reference) {
    if (!folder.empty()) stem_ = folder + "/" + file_stem(family + "-" + label);
}

void StressPictures::keep_worst(const Picture& picture, const PictureFigures& figures) {
    const double badness = 1e6 * static_cast<double>(figures.nans + figures.wrong) +
                           static_cast<double>(figures.wrong_at_edges) + figures.max_error;
    if (badness <= badness_) return;
    worst_ = picture;
    badness_ = badness;
}

void StressPictures::write() const {
    if (stem_.empty() || badness_ < 0) return;
    write_picture(stem_ + ".worst.png", worst_, Encoding::display);
    if (reference_ == nullptr) return;
    const Picture reference = reference_->as_picture();
    write_picture(stem_ + ".reference.png", reference, Encoding::display);
    write_picture(stem_ + ".error.png", heat_map(clamped(worst_), clamped(reference), 1.0 / 255),
                  Encoding::display);
}

}  // namespace rt
