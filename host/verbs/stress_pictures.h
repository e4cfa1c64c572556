// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/stress/judge.h"

namespace rt {

/// The pictures of one case in a folder: FAMILY-LABEL.reference.png, .worst.png, .error.png.
class StressPictures {
   public:
    /// Nothing is written if the folder name is empty. `reference` may be null.
    StressPictures(const std::string& folder, const std::string& family, const std::string& label,
                   const ReferencePicture* reference);

    /// Keeps the picture if it is the worst so far.
    void keep_worst(const Picture& picture, const PictureFigures& figures);

    /// Throws Error (ExitCode::output).
    void write() const;

   private:
    std::string stem_;  ///< empty: nothing is written
    const ReferencePicture* reference_;
    Picture worst_;
    double badness_ = -1;
};

}  // namespace rt
