// SPDX-License-Identifier: Apache-2.0
#include "image/tone_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/color.h"

namespace gischt {
namespace {

constexpr double middle_grey = 0.18;  // in and out: exposure 0 keeps the brightness of a picture
constexpr double white = 16;          // 6.5 stops above: sunlit clouds beside smoke in the shade
constexpr float contrast = 1.4f;      // exponent in the shadows; at middle grey 1.13 is left
constexpr float shoulder = 0.985f;    // below 1; nearer to 1 is a longer, softer shoulder
constexpr float leak = 0.10f;         // share of the other channels before the curve
constexpr float leak_back = 0.08f;    // and taken out after it

Vec3f toward_grey(const Vec3f& c, float share) {
    return c + share * (Vec3f(luminance(c)) - c);
}

// NaN becomes 0, as the comparison is false.
Vec3f not_negative(const Vec3f& c) {
    auto f = [](float v) { return v > 0 ? v : 0.0f; };
    return {f(c.x), f(c.y), f(c.z)};
}

Vec3f clip(const Vec3f& c) {
    return min(max(c, Vec3f(0)), Vec3f(1));
}

}  // namespace

const std::vector<std::string>& tone_names() {
    static const std::vector<std::string> names{"linear", "filmic"};
    return names;
}

ToneKind tone_kind(std::string_view name) {
    if (name == "linear") return ToneKind::Linear;
    if (name == "filmic") return ToneKind::Filmic;
    throw Error(ErrorKind::Usage, "tone", fmt::format("unknown tone curve '{}'", name),
                hint_for(name, tone_names()));
}

std::string_view tone_name(ToneKind kind) {
    return kind == ToneKind::Linear ? "linear" : "filmic";
}

// Solves curve(middle_grey) = middle_grey and curve(white) = 1 for b and c.
ToneCurve::ToneCurve(ToneKind kind) : kind_(kind) {
    const double a = contrast, ad = a * shoulder;
    const double grey_a = std::pow(middle_grey, a), grey_ad = std::pow(middle_grey, ad);
    const double white_a = std::pow(white, a), white_ad = std::pow(white, ad);
    const double b = (white_a - grey_a / middle_grey) / (white_ad - grey_ad);
    b_ = static_cast<float>(b);
    c_ = static_cast<float>(white_a - b * white_ad);
}

float ToneCurve::curve(float x) const {
    const float y = std::min(x, static_cast<float>(white));
    return std::pow(y, contrast) / (b_ * std::pow(y, contrast * shoulder) + c_);
}

Vec3f ToneCurve::operator()(const Vec3f& radiance) const {
    const Vec3f light = not_negative(radiance);
    if (kind_ == ToneKind::Linear) return clip(light);
    // Beyond this all channels are white, and infinities would meet in differences.
    const Vec3f x = toward_grey(min(light, Vec3f(1e6f)), leak);
    const Vec3f y{curve(x.x), curve(x.y), curve(x.z)};
    return clip(toward_grey(y, -leak_back / (1 - leak_back)));
}

}  // namespace gischt
