#include "draw/clip.h"

#include <cmath>
#include <limits>

namespace searchlight {

void PrintTo(const Point& p, std::ostream* out) { *out << '(' << p.x << ", " << p.y << ')'; }

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Rect frame{0, 0, 10, 10};
const double nan = std::numeric_limits<double>::quiet_NaN();

double area(const std::vector<Point>& outline) {
    double twice = 0;
    for (size_t i = 0; i < outline.size(); ++i) {
        const Point a = outline[i], b = outline[(i + 1) % outline.size()];
        twice += a.x * b.y - b.x * a.y;
    }
    return std::abs(twice) / 2;
}

TEST(ClipPolyline, KeepsWhatLiesInside) {
    const std::vector<Point> line{{1, 1}, {5, 2}, {9, 9}};
    EXPECT_THAT(clipPolyline(line, frame), ElementsAre(line));
}

TEST(ClipPolyline, CutsAtTheFrame) {
    EXPECT_THAT(clipPolyline(std::vector<Point>{{-5, 5}, {15, 5}}, frame),
                ElementsAre(ElementsAre(Point{0, 5}, Point{10, 5})));
    EXPECT_THAT(clipPolyline(std::vector<Point>{{5, 5}, {5, 20}}, frame),
                ElementsAre(ElementsAre(Point{5, 5}, Point{5, 10})));
}

TEST(ClipPolyline, LeavingAndComingBackMakesTwoPieces) {
    const std::vector<Point> line{{2, 5}, {2, 15}, {8, 15}, {8, 5}};
    EXPECT_THAT(clipPolyline(line, frame),
                ElementsAre(ElementsAre(Point{2, 5}, Point{2, 10}), ElementsAre(Point{8, 10}, Point{8, 5})));
}

TEST(ClipPolyline, OutsideIsNothing) {
    EXPECT_THAT(clipPolyline(std::vector<Point>{{-5, -1}, {15, -1}}, frame), IsEmpty());
    EXPECT_THAT(clipPolyline(std::vector<Point>{{-3, 2}, {2, -3}}, frame), IsEmpty()) << "passes the corner outside";
}

TEST(ClipPolyline, NanIsAGap) {
    const std::vector<Point> line{{1, 1}, {2, 2}, {3, nan}, {4, 4}, {nan, 5}, {6, 6}, {7, 7}};
    EXPECT_THAT(clipPolyline(line, frame), ElementsAre(ElementsAre(Point{1, 1}, Point{2, 2}), ElementsAre(Point{4, 4}),
                                                       ElementsAre(Point{6, 6}, Point{7, 7})));
}

TEST(ClipPolygon, AreaOfTheOverlapIsKept) {
    EXPECT_DOUBLE_EQ(area(clipPolygon({{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, frame)), 25);
    EXPECT_DOUBLE_EQ(area(clipPolygon({{-100, -100}, {100, -100}, {100, 100}, {-100, 100}}, frame)), 100);
    EXPECT_DOUBLE_EQ(area(clipPolygon({{5, -5}, {15, 5}, {5, 15}, {-5, 5}}, frame)), 100)
        << "a diamond through the frame's corners";
    EXPECT_THAT(clipPolygon({{20, 20}, {30, 20}, {30, 30}}, frame), IsEmpty());
    EXPECT_THAT(clipPolygon({}, frame), IsEmpty());
}

}  // namespace
}  // namespace searchlight
