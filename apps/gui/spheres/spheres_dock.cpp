#include "gui/spheres/spheres_dock.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "gui/models/model_files.h"
#include "gui/models/model_status.h"
#include "gui/plot/option_bar.h"
#include "gui/spheres/sphere_view.h"
#include "gui/window/seen.h"
#include "gui/window/theme.h"
#include "io/image_file.h"
#include "job/live/live_spheres.h"
#include "validate/image_error.h"

namespace searchlight::gui {

namespace {

constexpr const char* kLane = "spheres";
constexpr int kPictures = 3;

struct LaneSpheres {
    std::optional<LiveSpheres> spheres;
};

// What one step shows.
struct Shown {
    SpherePictures numbers;
    QImage model, reference, difference;
};

QImage displayedImage(const Image& image, double exposure) {
    if (image.empty()) return {};
    QImage shown(image.width, image.height, QImage::Format_ARGB32);
    for (int y = 0; y < image.height; ++y) {
        auto* line = reinterpret_cast<QRgb*>(shown.scanLine(y));
        for (int x = 0; x < image.width; ++x) {
            const Rgba pixel = displayed(image.at(x, y), {.exposure = exposure});
            const auto byte = [](float value) {
                return static_cast<int>(std::lround(255 * std::clamp(value, 0.f, 1.f)));
            };
            line[x] = qRgba(byte(pixel.r), byte(pixel.g), byte(pixel.b), byte(pixel.a));
        }
    }
    return shown;
}

QImage differenceOf(const SpherePictures& pictures, double full_scale) {
    if (pictures.model.empty() || pictures.reference.empty()) return {};
    try {
        Image image = searchlight::differenceImage(pictures.model, pictures.reference,
                                                   {.full_scale = full_scale, .is_signed = true});
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            Rgba& pixel = image.pixels[i];
            const float covered = pictures.reference.pixels[i].a;
            pixel = {covered * pixel.r, covered * pixel.g, covered * pixel.b, covered};
        }
        return displayedImage(image, 0);
    } catch (const Error&) {
        return {};  // the reference is black so far
    }
}

QString percent(double value) {
    return std::isfinite(value) ? QStringLiteral("%1 %").arg(100 * value, 0, 'f', 1) : QStringLiteral("–");
}

QString countText(double value) {
    return value >= 1e6 ? QStringLiteral("%1 M").arg(value / 1e6, 0, 'f', 1)
                        : QStringLiteral("%1 k").arg(value / 1e3, 0, 'f', 0);
}

class SpheresDock : public QWidget {
public:
    explicit SpheresDock(Desk& desk) : desk_(desk), lane_(std::make_shared<LaneSpheres>()), seen_(this) {
        connect(&seen_, &Seen::changed, this, &SpheresDock::setSeen);
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        auto* bar = new OptionBar(desk, "spheres", this);
        bar->addChoice("quality", tr("Quality"), {tr("Draft"), tr("Good"), tr("Fine")});
        bar->addNumber("exposure", tr("Exposure"), 1, 0.5)->setPrefix(tr("Exposure "));
        bar->addNumber("difference_scale", tr("End of the difference's scale"), 0, 10)->setPrefix(tr("Scale ±"));
        bar->addToggle("running", tr("Run"), QStringLiteral("play"));
        layout->addWidget(bar);
        view_ = new SphereView(desk, this);
        view_->setObjectName(QStringLiteral("spheres.view"));
        layout->addWidget(view_, 1);
        status_ = new QLabel(this);
        status_->setObjectName(QStringLiteral("spheres.status"));
        status_->setFont(desk.theme.smallFont());
        status_->setContentsMargins(Space::s, Space::xs, Space::s, Space::xs);
        status_->setWordWrap(true);
        status_->setTextInteractionFlags(Qt::TextSelectableByMouse);
        layout->addWidget(status_);
        desk_.tasks.atLaneEnd(kLane, [kept = lane_] { kept->spheres.reset(); });
        connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
            if (change.any({Part::material, Part::models, Part::parameters, Part::active, Part::lights, Part::object,
                            Part::camera, Part::options, Part::seed}))
                refresh();
        });
        connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this] { refresh(); });
        resize_.setSingleShot(true);
        resize_.setInterval(150);
        connect(&resize_, &QTimer::timeout, this, [this] { refresh(); });
        connect(view_, &SphereView::resized, this, [this] { resize_.start(); });
    }

private:
    double number(const char* name) const {
        return std::get<double>(optionOf(desk_.workspace.state(), "spheres", name));
    }

    SphereRequest request() const {
        const State& state = desk_.workspace.state();
        SphereRequest request;
        request.scene = sceneOf(state, state.active);
        // Turned with the object, but always framed.
        request.scene.camera.distance = 0;
        request.scene.camera.target = {};
        request.width = request.height = view_->pictureSide(kPictures);
        request.seed = state.seed;
        const std::string& quality = std::get<std::string>(optionOf(state, "spheres", "quality"));
        const double factor = quality == "draft" ? 1 : quality == "good" ? 8 : 64;
        request.samples = 32 * factor;
        request.walks = 5e5 * factor;
        request.cells = quality == "draft" ? 6'000 : 12'000;
        return request;
    }

    // Walks cost both cores: none for what nobody sees.
    void setSeen(bool seen) {
        if (seen) return refresh();
        desk_.tasks.cancel(kLane, "spheres");
        working_ = pending_ = false;
    }

    // As in the plot: a step that has begun is shown before the next wish begins.
    void refresh() {
        if (!seen_.now()) return;
        if (working_) {
            pending_ = true;
            return;
        }
        pending_ = false;
        working_ = true;
        const bool running = std::get<bool>(optionOf(desk_.workspace.state(), "spheres", "running"));
        desk_.tasks.start(
            {.lane = kLane, .key = "spheres", .title = tr("Lit spheres"), .background = true, .receiver = this},
            [this, kept = lane_, wish = request(), running, stops = number("exposure"),
             scale = number("difference_scale") / 100](TaskContext& context) {
                Engine& engine = context.engine();
                if (!kept->spheres) kept->spheres.emplace(engine);
                LiveSpheres& spheres = *kept->spheres;
                bool more = true, remade = false;
                do {
                    if (running) more = spheres.improve(wish, context);
                    if (engine.contextLost()) {
                        spheres.forgetModel();
                        engine.dropContext();
                        if (std::exchange(remade, true))
                            throw deviceError("OpenGL was lost while this model ran, twice");
                        continue;
                    }
                    auto shown = std::make_shared<Shown>();
                    shown->numbers = spheres.pictures(wish);
                    const double exposure = shown->numbers.exposure + stops;
                    shown->model = displayedImage(shown->numbers.model, exposure);
                    shown->reference = displayedImage(shown->numbers.reference, exposure);
                    shown->difference = differenceOf(shown->numbers, scale);
                    context.publish([this, shown, id = wish.scene.model.id] { show(*shown, id); });
                } while (running && more);
            },
            [this](const Error& error) {
                view_->setPanels({}, QString::fromUtf8(error.what()));
                status_->setText(QString::fromStdString(error.message));
                stepped();
            });
    }

    void stepped() {
        working_ = false;
        if (pending_) refresh();
    }

    void show(const Shown& shown, const std::string& id) {
        const SpherePictures& numbers = shown.numbers;
        const auto noise = [&](double SphereError::*member) {
            double largest = std::numeric_limits<double>::quiet_NaN();
            for (const SphereError& error : numbers.errors)
                if (std::isfinite(error.*member))
                    largest = std::isfinite(largest) ? std::max(largest, error.*member) : error.*member;
            return largest;
        };
        if (numbers.error) ModelStatus::of(desk_.workspace).set(id, *numbers.error);
        view_->setPanels(
            {{modelTitle(id), tr("%1 samples per cell").arg(numbers.samples), shown.model},
             {tr("Random walks"), tr("%1 walks").arg(countText(static_cast<double>(numbers.walks))), shown.reference},
             {tr("Difference"), tr("blue: too dark, orange: too bright"), shown.difference}},
            numbers.error ? QString::fromUtf8(numbers.error->what()) : tr("No light yet"));
        QStringList parts;
        if (numbers.error) parts << QString::fromUtf8(numbers.error->what());
        const char* const channels[] = {"R", "G", "B"};
        for (std::size_t c = 0; c < numbers.errors.size(); ++c) {
            const SphereError& error = numbers.errors[c];
            if (numbers.samples < 2 || numbers.walks == 0 || !std::isfinite(error.rmse)) continue;
            // "Mean difference R −1.2 ± 0.1 %", and for the others "G ...".
            parts << QStringLiteral("%1%2 %3%4 ± %5 %")
                         .arg(parts.isEmpty() ? tr("Mean difference ") : QString(), QLatin1String(channels[c]),
                              error.mean_difference.mean < 0 ? QStringLiteral("−") : QStringLiteral("+"))
                         .arg(100 * std::abs(error.mean_difference.mean), 0, 'f', 1)
                         .arg(100 * error.mean_difference.standard_error, 0, 'f', 1);
        }
        if (numbers.samples >= 2 && numbers.walks > 0)
            parts << tr("RMSE %1, of it noise %2")
                         .arg(percent(noise(&SphereError::rmse)), percent(noise(&SphereError::noise)));
        if (numbers.done) parts << tr("done");
        status_->setText(parts.join(QStringLiteral("  ·  ")));
        if (!shown.model.isNull()) desk_.trace.shown(QStringLiteral("spheres"));
        setProperty("settled", numbers.done);
        stepped();
    }

    Desk& desk_;
    std::shared_ptr<LaneSpheres> lane_;
    SphereView* view_ = nullptr;
    QLabel* status_ = nullptr;
    QTimer resize_;
    Seen seen_;
    bool working_ = false, pending_ = false;
};

}  // namespace

std::vector<Param> spheresOptions() {
    return {
        {.name = "quality",
         .type = ParamType::choice,
         .value = std::string("good"),
         .choices = {"draft", "good", "fine"},
         .doc = "how long both sides go on: up to 0.5, 4 or 32 million walks"},
        {.name = "exposure",
         .unit = "stops",
         .min = -16,
         .max = 16,
         .value = 0.0,
         .doc = "on top of what suits the walks"},
        {.name = "difference_scale",
         .unit = "%",
         .min = 1,
         .max = 1000,
         .value = 100.0,
         .doc = "the difference, of the walks' mean, at the ends of its scale"},
        {.name = "running", .type = ParamType::toggle, .value = true, .doc = "both sides go on"},
    };
}

QWidget* makeSpheresDock(Desk& desk) { return new SpheresDock(desk); }

}  // namespace searchlight::gui
