#include "draw/clip.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace searchlight {

namespace {

bool isGap(Point p) { return std::isnan(p.x) || std::isnan(p.y); }

Point mix(Point a, Point b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }

// The part of a segment inside the frame, [Liang1984].
std::optional<std::pair<Point, Point>> clipSegment(Point a, Point b, const Rect& frame) {
    double enter = 0, leave = 1;
    const auto cut = [&](double direction, double distance) {
        // direction * t <= distance is inside.
        if (direction == 0) return distance >= 0;
        const double t = distance / direction;
        if (direction < 0)
            enter = std::max(enter, t);
        else
            leave = std::min(leave, t);
        return enter <= leave;
    };
    if (!cut(a.x - b.x, a.x - frame.left) || !cut(b.x - a.x, frame.right - a.x) || !cut(a.y - b.y, a.y - frame.top) ||
        !cut(b.y - a.y, frame.bottom - a.y))
        return std::nullopt;
    return std::pair{enter > 0 ? mix(a, b, enter) : a, leave < 1 ? mix(a, b, leave) : b};
}

}  // namespace

std::vector<std::vector<Point>> clipPolyline(std::span<const Point> line, const Rect& frame) {
    std::vector<std::vector<Point>> pieces;
    bool open = false;  // the last piece may be continued
    for (size_t i = 0; i < line.size(); ++i) {
        if (isGap(line[i])) {
            open = false;
            continue;
        }
        const bool follows = i > 0 && !isGap(line[i - 1]);
        const bool leads = i + 1 < line.size() && !isGap(line[i + 1]);
        if (!follows && !leads && frame.contains(line[i])) pieces.push_back({line[i]});
        if (!follows) {
            open = false;
            continue;
        }
        const auto segment = clipSegment(line[i - 1], line[i], frame);
        if (!segment) {
            open = false;
            continue;
        }
        if (!open || pieces.back().back() != segment->first) pieces.push_back({segment->first});
        pieces.back().push_back(segment->second);
        open = true;
    }
    return pieces;
}

std::vector<Point> clipPolygon(std::vector<Point> outline, const Rect& frame) {
    // One half-plane after the other, [Sutherland1974]. `inside` is a signed distance, positive within.
    const auto cut = [&](auto inside) {
        std::vector<Point> kept;
        for (size_t i = 0; i < outline.size(); ++i) {
            const Point a = outline[i], b = outline[(i + 1) % outline.size()];
            const double da = inside(a), db = inside(b);
            if (da >= 0) kept.push_back(a);
            if ((da < 0) != (db < 0)) kept.push_back(mix(a, b, da / (da - db)));
        }
        outline = std::move(kept);
    };
    cut([&](Point p) { return p.x - frame.left; });
    cut([&](Point p) { return frame.right - p.x; });
    cut([&](Point p) { return p.y - frame.top; });
    cut([&](Point p) { return frame.bottom - p.y; });
    return outline;
}

}  // namespace searchlight
