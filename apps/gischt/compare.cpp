// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.h"
#include "image/compare.h"
#include "io/image_file.h"

namespace gischt {

int compare_images(const CompareOptions& options) {
    const Comparison c = compare(read_image(options.a), read_image(options.b));
    fmt::print("RMSE            {:.6g}\n", c.rmse);
    fmt::print("MSE             {:.6g}\n", c.mse);
    fmt::print("relative MSE    {:.6g}\n", c.rel_mse);
    fmt::print("mean A, B       {:.6g} {:.6g}\n", c.mean_a, c.mean_b);
    fmt::print("ratio of means  {:.6f}\n", c.ratio);
    fmt::print("PSNR            {:.2f} dB\n", c.psnr);
    fmt::print("largest diff.   {:.6g} in {} at ({}, {})\n", c.max_difference, c.max_channel,
               c.max_x, c.max_y);
    if (c.not_finite > 0) fmt::print("not finite      {} values\n", c.not_finite);
    const bool failed = options.tolerance && !(c.rmse <= *options.tolerance);
    if (failed) fmt::print("RMSE is above the tolerance of {:g}\n", *options.tolerance);
    return failed ? 1 : 0;
}

}  // namespace gischt
