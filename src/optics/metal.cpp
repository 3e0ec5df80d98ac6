// SPDX-License-Identifier: Apache-2.0
#include "optics/metal.h"

namespace gischt {

MetalIndex metal_index(Metal metal) {
    switch (metal) {
        case Metal::Gold:
            return {{0.1431f, 0.3750f, 1.4424f}, {3.9831f, 2.3857f, 1.6032f}};
        case Metal::Copper:
            return {{0.2004f, 0.9240f, 1.1022f}, {3.9129f, 2.4528f, 2.1421f}};
        case Metal::Aluminium:
            return {{1.6574f, 0.8803f, 0.5212f}, {9.2238f, 6.2695f, 4.8370f}};
        case Metal::Silver:
            return {{0.1552f, 0.1167f, 0.1383f}, {4.8283f, 3.1222f, 2.1470f}};
        case Metal::Iron:
            return {{2.9114f, 2.9497f, 2.5845f}, {3.3599f, 3.3946f, 3.4131f}};
        case Metal::Chrome:
            return {{3.1800f, 3.1800f, 3.1800f}, {3.2759f, 3.3431f, 3.3238f}};
    }
    return {};
}

}  // namespace gischt
