// SPDX-License-Identifier: Apache-2.0
#include "render/field/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "base/units.h"
#include "grid/frame.h"
#include "image/draw.h"
#include "render/field/legend.h"
#include "render/field/quantity.h"
#include "render/field/slice.h"

namespace gischt {
namespace {

// Where the slice lies in the picture: pixels [at, at + size).
struct Panel {
    Vec2i at, size;
};

class FieldPicture {
  public:
    FieldPicture(const View& view, const FieldParams& params) : view_(view), params_(params) {
        choose_quantity();
        slice_.emplace(*quantity_.field, axes_, params_.position, quantity_.at);
        choose_range();
        style_.scale = std::max(1, (std::min(view.width(), view.height()) + 160) / 320);
        image_ = Image::rgba(view.width(), view.height());
        fill_rectangle(image_, {0, 0}, {view.width(), view.height()}, style_.paper);
    }

    RenderResult draw() {
        lay_out();
        draw_slice();
        if (params_.arrows) draw_arrows();
        if (has_legend_) draw_texts();
        RenderResult result;
        describe();
        std::fill(image_.channel("A").begin(), image_.channel("A").end(), 1.0f);
        result.image = std::move(image_);
        result.statistics.samples_per_pixel = 1;
        result.statistics.lookups = static_cast<std::int64_t>(lookups_);
        return result;
    }

  private:
    void choose_quantity() {
        std::set<std::string> names;
        for (const auto& frame : view_.frames) {
            // The axes are needed to know what vorticity is, and the field to know the axes.
            Quantity q = find_quantity(*frame, params_.quantity, 2);
            if (q.field && !q.field->component.empty()) {
                axes_ =
                    slice_axes(*q.field, params_.axis, view_.camera.forward(), view_.camera.up());
                quantity_ = find_quantity(*frame, params_.quantity, axes_.normal);
                frame_ = frame.get();
                return;
            }
            for (std::string& name : quantity_names(*frame)) names.insert(std::move(name));
        }
        const std::vector<std::string> list(names.begin(), names.end());
        throw Error(ErrorKind::Usage, "field",
                    fmt::format("there is no field '{}' to show", params_.quantity),
                    list.empty() ? "the view has no frame" : hint_for(params_.quantity, list));
    }

    void choose_range() {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const float v : slice_->values()) {
            if (!std::isfinite(v)) continue;
            low = std::min(low, static_cast<double>(v));
            high = std::max(high, static_cast<double>(v));
        }
        if (!(low <= high)) low = 0, high = 1;
        const bool both_signs = quantity_.is_signed && low < 0 && high > 0;
        if (both_signs) high = std::max(-low, high), low = -high;
        colormap_ = params_.colormap ? *params_.colormap
                                     : (both_signs ? ColormapKind::Coolwarm : quantity_.colormap);
        range_ = params_.range ? *params_.range : Vec2d{low, high};
        if (range_.x == range_.y) range_.y = range_.x + (range_.x != 0 ? std::abs(range_.x) : 1);
        if (!(range_.x < range_.y)) {
            throw Error(ErrorKind::Usage, "field", "the range has its higher end first");
        }
    }

    // The largest panel of the slice's aspect beside the legend and below the title.
    void lay_out() {
        const int s = style_.scale;
        int left = 0, top = 0, right = 0, bottom = 0;
        if (has_legend_) {
            ticks_ = make_ticks(range_.x, range_.y, std::clamp(view_.height() / (24 * s), 2, 8));
            left = bottom = 8 * s;
            top = 22 * s;
            right = 16 * s + legend_width(ticks_, style_);
            // A picture too small for a legend beside a panel goes without.
            if (left + right + 16 > view_.width() || top + bottom + 16 > view_.height()) {
                has_legend_ = false;
                left = top = right = bottom = 0;
            }
        }
        const int room_x = std::max(1, view_.width() - left - right);
        const int room_y = std::max(1, view_.height() - top - bottom);
        const double aspect =
            (slice_->high().x - slice_->low().x) / (slice_->high().y - slice_->low().y);
        panel_.size.x = std::clamp(static_cast<int>(std::lround(room_y * aspect)), 1, room_x);
        panel_.size.y = std::clamp(static_cast<int>(std::lround(room_x / aspect)), 1, room_y);
        // The panel and its legend stand in the middle together.
        panel_.at = {left + (room_x - panel_.size.x) / 2, top + (room_y - panel_.size.y) / 2};
    }

    // Metres along right and up of a point of the picture in pixels.
    Vec2d metres(double x, double y) const {
        const double u = (x - panel_.at.x) / panel_.size.x, v = (y - panel_.at.y) / panel_.size.y;
        return {lerp(slice_->low().x, slice_->high().x, u),
                lerp(slice_->high().y, slice_->low().y, v)};
    }

    void draw_slice() {
        // Where a pixel covers several cells, it shows their mean.
        const int nx = std::clamp(slice_->width() / panel_.size.x, 1, 16);
        const int ny = std::clamp(slice_->height() / panel_.size.y, 1, 16);
        const auto color = image_.color();
        parallel_for(panel_.size.y, 8, [&](int row) {
            for (int column = 0; column < panel_.size.x; ++column) {
                float sum = 0;
                for (int s = 0; s < nx * ny; ++s) {
                    const Vec2d p = metres(panel_.at.x + column + (s % nx + 0.5) / nx,
                                           panel_.at.y + row + (s / nx + 0.5) / ny);
                    sum += slice_->at(p.x, p.y, params_.interpolation);
                }
                const double value = static_cast<double>(sum) / (nx * ny);
                const Vec3f c = colormap(
                    colormap_, static_cast<float>((value - range_.x) / (range_.y - range_.x)));
                const std::size_t i = image_.index(panel_.at.x + column, panel_.at.y + row);
                color[0][i] = c.x;
                color[1][i] = c.y;
                color[2][i] = c.z;
            }
        });
        lookups_ += static_cast<std::size_t>(panel_.size.x * panel_.size.y * nx * ny);
    }

    void draw_arrows() {
        const Field* velocity = frame_->find("velocity");
        if (!velocity || !velocity->is_vector()) return;
        const auto along = [&](int axis) {
            const Vec3d unit = normalize(velocity->to_world.column[static_cast<std::size_t>(axis)]);
            return Slice(*velocity, axes_, slice_->position(), [=](const Vec3i& cell) {
                Vec3d v;
                for (int a = 0; a < 3; ++a) {
                    const auto c = static_cast<std::size_t>(a);
                    v[a] = static_cast<double>(
                        velocity->component[c].get(cell, velocity->background[c]));
                }
                return static_cast<float>(dot(v, unit));
            });
        };
        const Slice right = along(axes_.right), up = along(axes_.up);

        // Arrows on a grid that is centred in the panel, and the largest of their speeds.
        struct Arrow {
            Vec2f center, velocity;
        };
        std::vector<Arrow> arrows;
        const int spacing = params_.arrow_spacing;
        double fastest = 0;
        for (int y = panel_.size.y % spacing / 2 + spacing / 2; y < panel_.size.y; y += spacing) {
            for (int x = panel_.size.x % spacing / 2 + spacing / 2; x < panel_.size.x;
                 x += spacing) {
                const Vec2d p = metres(panel_.at.x + x, panel_.at.y + y);
                const Vec2f v{right.at(p.x, p.y, FieldInterpolation::Linear),
                              up.at(p.x, p.y, FieldInterpolation::Linear)};
                if (!std::isfinite(v.x + v.y)) continue;
                fastest = std::max(fastest, std::hypot(double(v.x), double(v.y)));
                arrows.push_back(
                    {{static_cast<float>(panel_.at.x + x), static_cast<float>(panel_.at.y + y)},
                     v});
            }
        }
        arrow_speed_ = params_.arrow_speed ? *params_.arrow_speed : fastest;
        if (!(arrow_speed_ > 0)) return;
        const float scale = static_cast<float>(0.95 * spacing / arrow_speed_);
        for (const Arrow& a : arrows) {
            draw_arrow_on_color(a.center, {scale * a.velocity.x, -scale * a.velocity.y});
        }
    }

    // White with a dark edge, so that it is seen on any colour; below a pixel it is left out.
    void draw_arrow_on_color(Vec2f center, Vec2f length) {
        if (std::hypot(length.x, length.y) < 1) return;
        const Vec2f from{center.x - 0.5f * length.x, center.y - 0.5f * length.y};
        const Vec2f to{center.x + 0.5f * length.x, center.y + 0.5f * length.y};
        const float width = 1.0f + 0.4f * static_cast<float>(style_.scale - 1);
        // The edge is the same arrow, dark, shifted by a little in eight directions.
        for (int n = 0; n < 8; ++n) {
            const auto angle = static_cast<float>(n * pi / 4);
            const Vec2f d{0.8f * std::cos(angle), 0.8f * std::sin(angle)};
            draw_arrow(image_, {from.x + d.x, from.y + d.y}, {to.x + d.x, to.y + d.y}, Vec3f(0.02f),
                       width);
        }
        draw_arrow(image_, from, to, Vec3f(0.95f), width);
    }

    void draw_texts() {
        const int s = style_.scale;
        draw_legend(image_, {panel_.at.x + panel_.size.x + 8 * s, panel_.at.y}, panel_.size.y,
                    colormap_, range_, ticks_, style_);
        std::string title = quantity_.name;
        std::string unit(quantity_.unit);
        if (ticks_.exponent != 0) {
            unit = fmt::format("1e{}{}{}", ticks_.exponent, unit.empty() ? "" : " ", unit);
        }
        if (!unit.empty()) title = fmt::format("{} ({})", title, unit);
        draw_text(image_, {panel_.at.x, panel_.at.y - 14 * s}, title, style_.ink, s);

        // Of the texts on the right the longest that fits beside the title.
        const std::string time = fmt::format("t = {:.3f} s", frame_->time);
        std::vector<std::string> choices{time, ""};
        if (arrow_speed_ > 0) {
            choices.insert(choices.begin(),
                           fmt::format("arrow {:.3g} m/s   {}", arrow_speed_, time));
        }
        const int room = panel_.size.x - text_size(title, s).x - 6 * s;
        for (const std::string& text : choices) {
            const int width = text_size(text, s).x;
            if (width > room) continue;
            const int x = panel_.at.x + panel_.size.x - width;
            draw_text(image_, {x, panel_.at.y - 14 * s}, text, style_.ink, s);
            break;
        }
    }

    void describe() {
        Metadata& m = image_.metadata;
        m.set("method", "field");
        m.set("tone", "linear");
        m.set("display_referred", "true");
        m.set("quantity", quantity_.name);
        m.set("unit", quantity_.unit);
        m.set("range_low", fmt::format("{:.9g}", range_.x));
        m.set("range_high", fmt::format("{:.9g}", range_.y));
        m.set("slice", fmt::format("{} = {:.6g} m", "xyz"[axes_.normal], slice_ -> position()));
    }

    const View& view_;
    const FieldParams& params_;
    bool has_legend_ = params_.legend;
    const Frame* frame_{};
    Quantity quantity_;
    SliceAxes axes_;
    std::optional<Slice> slice_;
    Vec2d range_;
    ColormapKind colormap_ = ColormapKind::Viridis;
    LegendStyle style_;
    Ticks ticks_;
    Panel panel_;
    Image image_;
    double arrow_speed_ = 0;
    std::size_t lookups_ = 0;
};

class FieldMethod : public RenderMethod {
  public:
    explicit FieldMethod(const FieldParams& params) : params_(params) {}

    RenderResult render(const View& view, const RenderSettings& settings, Job& job) override {
        const PhaseTimer timer(job, "field");
        const double start = now_seconds();
        job.check();
        RenderResult result = FieldPicture(view, params_).draw();
        result.image.metadata.set("seed", fmt::format("{}", settings.seed));
        result.statistics.wall_seconds = now_seconds() - start;
        job.progress(1, "field");
        return result;
    }

  private:
    FieldParams params_;
};

}  // namespace

std::unique_ptr<RenderMethod> make_field_method(const FieldParams& params) {
    return std::make_unique<FieldMethod>(params);
}

}  // namespace gischt
