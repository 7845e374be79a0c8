#include "draw/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "draw/text_width.h"

namespace searchlight {

namespace {

bool isXmlCharacter(char32_t code) {
    return code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code != 0xFFFE && code != 0xFFFF);
}

std::string number(double value) {
    const double rounded = std::round(value * 100) / 100;
    return fmt::format("{}", rounded == 0 ? 0.0 : rounded);  // no minus zero
}

std::string pointList(std::span<const Point> points) {
    std::string list, last;
    for (const Point& p : points) {
        std::string pair = number(p.x) + ',' + number(p.y);
        if (pair == last) continue;
        if (!list.empty()) list += ' ';
        list += pair;
        last = std::move(pair);
    }
    return list;
}

// [RFC 4648, sec. 4].
std::string base64(std::string_view bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t taken = std::min<std::size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < taken ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= taken ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

// Writes one shape.
struct SvgWriter {
    std::string svg;

    template <class... Parts>
    void add(fmt::format_string<Parts...> format, Parts&&... parts) {
        fmt::format_to(std::back_inserter(svg), format, std::forward<Parts>(parts)...);
    }

    void operator()(const Polyline& line) {
        if (line.points.size() == 1) return (*this)(Circle{line.points[0], line.stroke.width, line.stroke.color});
        const Stroke& stroke = line.stroke;
        add("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"",
            pointList(line.points), stroke.color, stroke.width);
        if (!stroke.dashes.empty()) add(" stroke-dasharray=\"{}\"", fmt::join(stroke.dashes, " "));
        svg += "/>\n";
    }

    void operator()(const Polygon& area) {
        add("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"{}\"/>\n", pointList(area.points), area.color,
            area.opacity);
    }

    void operator()(const Box& box) {
        add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"", number(box.rect.left),
            number(box.rect.top), number(box.rect.width()), number(box.rect.height()),
            box.fill.empty() ? "none" : box.fill);
        if (box.opacity < 1) add(" fill-opacity=\"{}\"", box.opacity);
        if (!box.outline.empty()) add(" stroke=\"{}\"", box.outline);
        svg += "/>\n";
    }

    void operator()(const Circle& circle) {
        add("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{}\"/>\n", number(circle.center.x), number(circle.center.y),
            number(circle.radius), circle.color);
    }

    void operator()(const Text& text) {
        if (text.upwards)
            add("<text transform=\"translate({} {}) rotate(-90)\"", number(text.at.x), number(text.at.y));
        else
            add("<text x=\"{}\" y=\"{}\"", number(text.at.x), number(text.at.y));
        constexpr std::string_view anchors[] = {"start", "middle", "end"};
        add(" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"{}>{}</text>\n", text.size,
            anchors[static_cast<int>(text.anchor)], text.color, text.bold ? " font-weight=\"bold\"" : "",
            escapeXml(text.text));
    }

    void operator()(const Picture& picture) {
        const Rect& rect = picture.rect;
        add("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
            number(rect.left), number(rect.top), number(rect.width()), number(rect.height()), base64(picture.png));
    }
};

}  // namespace

std::string escapeXml(std::string_view text) {
    std::string escaped;
    while (!text.empty()) {
        const std::string_view before = text;
        const char32_t code = nextCharacter(text);
        const std::string_view bytes = before.substr(0, before.size() - text.size());
        switch (code) {
            case '&': escaped += "&amp;"; break;
            case '<': escaped += "&lt;"; break;
            case '>': escaped += "&gt;"; break;
            case '"': escaped += "&quot;"; break;
            default:
                if (code == U'\uFFFD' || !isXmlCharacter(code))
                    escaped += "\uFFFD";
                else
                    escaped += bytes;
        }
    }
    return escaped;
}

std::string svgElement(const Drawing& drawing, const Figure& figure) {
    SvgWriter writer;
    writer.add(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
        "font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\">\n<title>{2}</title>\n",
        number(drawing.width), number(drawing.height), escapeXml(figure.title));
    writer.svg += "<metadata>\n";
    for (const auto& [key, value] : figure.metadata) writer.add("{}: {}\n", escapeXml(key), escapeXml(value));
    writer.svg += "</metadata>\n";
    for (const Shape& shape : drawing.shapes) std::visit(writer, shape);
    return writer.svg + "</svg>\n";
}

}  // namespace searchlight
