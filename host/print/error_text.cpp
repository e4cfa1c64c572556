// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/base/text.h"
#include "host/print/print_image_error.h"

namespace rt {

namespace {

std::string count_line(const char* name, std::size_t count, std::size_t pixels) {
    return fmt::format("  {:<12}{} ({:.2f} %)\n", name, counted(count, "pixel"),
                       100.0 * static_cast<double>(count) / static_cast<double>(pixels));
}

}  // namespace

std::string error_table(const ImageError& error, std::size_t pixels) {
    std::string text = count_line("not finite", error.non_finite, pixels);
    if (error.non_finite == pixels) return text + "  no pixel is finite in both pictures\n";
    text +=
        fmt::format("  {:<12}{:.4e}\n  {:<12}{:.4e}\n  {:<12}{:.4e} at {},{}\n  {:<12}{:.2f} dB\n",
                    "RMSE", error.rmse, "mean", error.mean, "maximum", error.max, error.max_x,
                    error.max_y, "PSNR", error.psnr);
    text += count_line("over 1/255", error.over_1, pixels);
    text += count_line("over 2/255", error.over_2, pixels);
    text += count_line("over 8/255", error.over_8, pixels);
    return text + fmt::format("  {:<12}{:.4e}\n", "relMSE", error.rel_mse);
}

}  // namespace rt
