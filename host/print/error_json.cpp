// SPDX-License-Identifier: Apache-2.0
#include "host/print/print_image_error.h"

namespace rt {

nlohmann::ordered_json error_json(const ImageError& error) {
    return {{"rmse", error.rmse},
            {"mean", error.mean},
            {"max", error.max},
            {"max_at", {error.max_x, error.max_y}},
            {"psnr_db", error.psnr},
            {"rel_mse", error.rel_mse},
            {"pixels_over_1_255", error.over_1},
            {"pixels_over_2_255", error.over_2},
            {"pixels_over_8_255", error.over_8},
            {"non_finite", error.non_finite}};
}

}  // namespace rt
