#ifdef SEARCHLIGHT_QT

#include "draw/paint_qt.h"

#include <fmt/format.h>

#include <QBuffer>
#include <QFontDatabase>
#include <QGuiApplication>
#include <QImage>
#include <QPageSize>
#include <QPainter>
#include <QPdfWriter>
#include <variant>

#include "base/error.h"
#include "base/version.h"
#include "draw/figure_layout.h"
#include "draw/svg.h"

namespace searchlight {

namespace {

constexpr int pixels_per_px = 2;        // 192 dpi
constexpr double points_per_px = 0.75;  // px are 1/96 inch

// Fonts live in a QGuiApplication. Where a window made one, that is used; otherwise one without a display, also when
// DISPLAY is set: a display that has gone away would end the process. It stays until the process ends, because Qt may
// be started only once.
void ensureApplication() {
    // Once, whichever thread draws first.
    static const bool ensured = [] {
        if (QCoreApplication::instance()) return true;
        static int argc = 3;
        static char name[] = "searchlight", option[] = "-platform", platform[] = "offscreen";
        static char* argv[] = {name, option, platform, nullptr};
        // Qt's remarks about the session (no XDG_RUNTIME_DIR...) are not the user's concern.
        const QtMessageHandler speaking =
            qInstallMessageHandler([](QtMsgType, const QMessageLogContext&, const QString&) {});
        new QGuiApplication(argc, argv);
        qInstallMessageHandler(speaking);
        return true;
    }();
    (void)ensured;
}

QString fromUtf8(std::string_view text) { return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size())); }

// The first of the families that SVG files name; any other where none is there.
QString installedFont() {
    const QStringList families = QFontDatabase::families();
    if (families.isEmpty())
        throw deviceError("no font is installed, so a picture would have no text", "apt install fonts-dejavu-core");
    for (const char* name : {"Helvetica", "Arial", "Liberation Sans", "DejaVu Sans"})
        if (families.contains(QLatin1String(name))) return QLatin1String(name);
    return families.first();
}

QPolygonF pointsOf(const std::vector<Point>& points) {
    QPolygonF result;
    for (const Point& p : points) result << QPointF(p.x, p.y);
    return result;
}

// Paints one shape.
struct ShapePainter {
    QPainter& painter;
    QString family;
    const InkFunction& ink;

    QColor colorOf(std::string_view color, double opacity = 1) const {
        QColor result(ink ? QString::fromStdString(ink(color)) : fromUtf8(color));
        result.setAlphaF(static_cast<float>(opacity));
        return result;
    }

    void operator()(const Polyline& line) const {
        if (line.points.size() == 1) return (*this)(Circle{line.points[0], line.stroke.width, line.stroke.color});
        QPen pen(colorOf(line.stroke.color), line.stroke.width, Qt::SolidLine, Qt::FlatCap, Qt::RoundJoin);
        if (!line.stroke.dashes.empty()) {
            QList<qreal> pattern;  // Qt counts in line widths
            for (const double length : line.stroke.dashes) pattern << length / line.stroke.width;
            pen.setDashPattern(pattern);
        }
        painter.setPen(pen);
        painter.setBrush(Qt::NoBrush);
        painter.drawPolyline(pointsOf(line.points));
    }

    void operator()(const Polygon& area) const {
        painter.setPen(Qt::NoPen);
        painter.setBrush(colorOf(area.color, area.opacity));
        painter.drawPolygon(pointsOf(area.points), Qt::OddEvenFill);
    }

    void operator()(const Box& box) const {
        painter.setPen(box.outline.empty() ? QPen(Qt::NoPen) : QPen(colorOf(box.outline), 1));
        painter.setBrush(box.fill.empty() ? QBrush(Qt::NoBrush) : QBrush(colorOf(box.fill, box.opacity)));
        painter.drawRect(QRectF(box.rect.left, box.rect.top, box.rect.width(), box.rect.height()));
    }

    void operator()(const Circle& circle) const {
        painter.setPen(Qt::NoPen);
        painter.setBrush(colorOf(circle.color));
        painter.drawEllipse(QPointF(circle.center.x, circle.center.y), circle.radius, circle.radius);
    }

    void operator()(const Text& text) const {
        QFont font(family);
        font.setPixelSize(static_cast<int>(text.size));
        font.setBold(text.bold);
        font.setHintingPreference(QFont::PreferNoHinting);
        const QString string = fromUtf8(text.text);
        const double width = QFontMetricsF(font, painter.device()).horizontalAdvance(string);
        const double shift = text.anchor == Anchor::start ? 0 : text.anchor == Anchor::middle ? 0.5 * width : width;
        painter.save();
        painter.translate(text.at.x, text.at.y);
        if (text.upwards) painter.rotate(-90);
        painter.setFont(font);
        painter.setPen(colorOf(text.color));
        painter.drawText(QPointF(-shift, 0), string);
        painter.restore();
    }

    void operator()(const Picture& picture) const {
        QImage image;
        image.loadFromData(reinterpret_cast<const uchar*>(picture.png.data()), static_cast<int>(picture.png.size()),
                           "PNG");
        const QRectF box(picture.rect.left, picture.rect.top, picture.rect.width(), picture.rect.height());
        // A painter samples between pixels; what shrinks has to be averaged first.
        const QSize size = painter.transform().mapRect(box).size().toSize();
        if (size.width() < image.width()) image = image.scaled(size, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
        painter.drawImage(box, image);
    }
};

void paint(QPaintDevice& device, const Drawing& drawing, double scale) {
    QPainter painter(&device);
    painter.scale(scale, scale);
    paintShapes(painter, drawing.shapes);
}

// The packet replaces Qt's, which holds the time of writing.
QByteArray xmpPacket(const Figure& figure) {
    std::string description;
    for (const auto& [key, value] : figure.metadata) description += fmt::format("{}: {}\n", key, value);
    return QByteArray::fromStdString(fmt::format(
        "<?xpacket begin=\"\uFEFF\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
        "<rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\">\n"
        "<dc:title><rdf:Alt><rdf:li xml:lang=\"x-default\">{}</rdf:li></rdf:Alt></dc:title>\n"
        "<dc:description><rdf:Alt><rdf:li xml:lang=\"x-default\">{}</rdf:li></rdf:Alt></dc:description>\n"
        "</rdf:Description></rdf:RDF></x:xmpmeta>\n<?xpacket end=\"r\"?>",
        escapeXml(figure.title), escapeXml(description)));
}

// The same figure gives the same bytes: the time of writing is overwritten in place, digit by digit.
void eraseDate(QByteArray& pdf) {
    constexpr char mark[] = "/CreationDate (D:", fixed[] = "19700101000000";
    const qsizetype at = pdf.indexOf(mark);
    if (at >= 0)
        pdf.replace(at + qsizetype(sizeof mark - 1), qsizetype(sizeof fixed - 1), fixed, qsizetype(sizeof fixed - 1));
}

}  // namespace

void paintShapes(QPainter& painter, const std::vector<Shape>& shapes, const InkFunction& ink) {
    static const QString family = installedFont();
    painter.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing | QPainter::SmoothPixmapTransform);
    for (const Shape& shape : shapes) std::visit(ShapePainter{painter, family, ink}, shape);
}

std::string drawingBitmap(const Drawing& drawing, const Figure& figure, const char* format) {
    ensureApplication();
    QImage image(static_cast<int>(drawing.width) * pixels_per_px, static_cast<int>(drawing.height) * pixels_per_px,
                 QImage::Format_RGB32);
    paint(image, drawing, pixels_per_px);
    constexpr double inches_per_metre = 39.37;
    image.setDotsPerMeterX(static_cast<int>(96 * pixels_per_px * inches_per_metre));
    image.setDotsPerMeterY(image.dotsPerMeterX());
    image.setText(QStringLiteral("Title"), fromUtf8(figure.title));
    for (const auto& [key, value] : figure.metadata) image.setText(fromUtf8(key), fromUtf8(value));
    QBuffer bytes;
    bytes.open(QIODevice::WriteOnly);
    constexpr int jpeg_quality = 88;
    if (!image.save(&bytes, format, std::string_view(format) == "JPG" ? jpeg_quality : -1))
        throw deviceError(fmt::format("Qt cannot write {} here", format), "its image plugins are not installed");
    return bytes.data().toStdString();
}

std::string figurePng(const Figure& figure) { return drawingBitmap(layoutFigure(figure), figure, "PNG"); }

std::string figurePdf(const Figure& figure) {
    const Drawing drawing = layoutFigure(figure);
    ensureApplication();
    QBuffer bytes;
    bytes.open(QIODevice::WriteOnly);
    QPdfWriter writer(&bytes);
    writer.setCreator(fromUtf8(fmt::format("Searchlight {}", version())));
    writer.setTitle(fromUtf8(figure.title));
    writer.setDocumentXmpMetadata(xmpPacket(figure));
    writer.setPageSize(QPageSize(QSizeF(drawing.width, drawing.height) * points_per_px, QPageSize::Point, QString(),
                                 QPageSize::ExactMatch));
    writer.setPageMargins(QMarginsF());
    paint(writer, drawing, writer.resolution() / 96.0);
    QByteArray pdf = bytes.data();
    eraseDate(pdf);
    return pdf.toStdString();
}

}  // namespace searchlight

#endif
