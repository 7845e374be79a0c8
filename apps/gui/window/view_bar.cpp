#include "gui/window/view_bar.h"

#include <QComboBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "gui/view/technique_options.h"
#include "gui/widgets/flow_row.h"
#include "gui/widgets/number_slider.h"
#include "gui/widgets/segments.h"
#include "gui/window/theme.h"
#include "model/model.h"
#include "render/technique.h"

namespace searchlight::gui {

namespace {

const char* const compare_values[] = {"none", "wipe", "difference"};

QString titleOf(const std::string& id) {
    for (const Model& model : shippedModels())
        if (model.id == id) return QString::fromStdString(model.file.title);
    return QFileInfo(QString::fromStdString(id)).completeBaseName();
}

QIcon dot(QColor color) {
    QPixmap pixmap(24, 24);
    pixmap.setDevicePixelRatio(2);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawEllipse(QRectF(2, 2, 8, 8));
    return QIcon(pixmap);
}

}  // namespace

ViewBar::ViewBar(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    setObjectName("view_bar");
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(Space::s, 0, Space::s, Space::s);
    column->setSpacing(Space::xs);
    auto* first = new FlowRow;
    auto* second = new FlowRow;
    column->addLayout(first);
    column->addLayout(second);
    // What belongs together stays in one row.
    const auto group = [this](FlowRow* row) {
        auto* box = new QWidget(this);
        auto* inner = new QHBoxLayout(box);
        inner->setContentsMargins(0, 0, 0, 0);
        inner->setSpacing(Space::s);
        row->addWidget(box);
        return inner;
    };

    model_ = makeBox(tr("Model"), tr("The model that the object is rendered with"));
    connect(model_, &QComboBox::activated, this, [this](int index) {
        desk_.workspace.edit(tr("Active model"), {}, [&](State& state) { state.active = index; });
    });
    technique_ = makeBox(tr("Technique"), tr("How the light in the object is summed"));
    for (const TechniqueEntry& entry : techniques()) {
        const QString id = QString::fromUtf8(entry.id.data(), static_cast<qsizetype>(entry.id.size()));
        technique_->addItem(techniqueTitle(entry.id), id);
        technique_->setItemData(technique_->count() - 1,
                                QString::fromUtf8(entry.summary.data(), static_cast<qsizetype>(entry.summary.size())),
                                Qt::ToolTipRole);
    }
    connect(technique_, &QComboBox::activated, this, [this] {
        desk_.workspace.edit(tr("Technique"), {}, [&](State& state) {
            state.technique = technique_->currentData().toString().toStdString();
            state.technique_options.clear();
        });
    });
    QHBoxLayout* made_with = group(first);
    made_with->addWidget(model_, 3);
    made_with->addWidget(technique_, 2);
    made_with->addWidget(makeTechniqueButton());
    compare_ = new Segments(tr("Compare"), {tr("Alone"), tr("Wipe"), tr("Difference")}, this);
    connect(compare_, &Segments::chosen, this, [this](int chosen) {
        desk_.workspace.setOption(tr("Compare"), "view", "compare", std::string(compare_values[chosen]));
        desk_.workspace.endGesture();
    });
    QHBoxLayout* beside = group(first);
    beside->addWidget(compare_);
    against_ = makeBox(tr("Compared with"), tr("The reference, another model or another technique"));
    connect(against_, &QComboBox::activated, this, [this] {
        desk_.workspace.setOption(tr("Compare with"), "view", "against",
                                  against_->currentData().toString().toStdString());
        desk_.workspace.endGesture();
    });
    beside->addWidget(against_, 1);

    QHBoxLayout* shown = group(second);
    shown->addWidget(makeOption("layer", tr("Layer")));
    shown->addWidget(makeOption("channel", tr("Channel")));
    shown->addWidget(makeOption("curve", tr("Tone curve")));
    shown->addStretch(1);
    auto_ = new QToolButton(this);
    auto_->setText(tr("Auto"));
    auto_->setCheckable(true);
    auto_->setToolTip(tr("The exposure that suits object and light"));
    auto_->setAccessibleName(tr("Automatic exposure"));
    connect(auto_, &QToolButton::clicked, this, [this](bool on) {
        desk_.workspace.setOption(tr("Automatic exposure"), "view", "auto_exposure", on);
        desk_.workspace.endGesture();
    });
    exposure_ = new NumberSlider(desk_.theme, {}, tr("Exposure"), tr("stops"),
                                 {.min = -16, .max = 16, .low = -6, .high = 6}, {}, this);
    connect(exposure_, &NumberSlider::edited, this, [this](double stops) {
        desk_.workspace.edit(tr("Exposure"), "view.exposure", [&](State& state) {
            state.options["view"]["exposure"] = stops;
            state.options["view"]["auto_exposure"] = false;
        });
    });
    difference_ = new NumberSlider(desk_.theme, {}, tr("Scale of the difference"), "%",
                                   {.min = 0.1, .max = 1000, .low = 0.1, .high = 200, .logarithmic = true}, {}, this);
    connect(difference_, &NumberSlider::edited, this, [this](double percent) {
        desk_.workspace.setOption(tr("Scale of the difference"), "view", "difference_scale", percent);
    });
    for (NumberSlider* each : {exposure_, difference_})
        connect(each, &NumberSlider::finished, &desk_.workspace, &Workspace::endGesture);
    QHBoxLayout* brightness = group(second);
    brightness->addWidget(auto_);
    brightness->addWidget(exposure_, 1);
    brightness->addWidget(difference_, 1);

    connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
        if (change.any({Part::models, Part::active, Part::technique, Part::options})) refresh();
    });
    connect(&desk_.theme, &Theme::changed, this, &ViewBar::refresh);
    refresh();
}

QToolButton* ViewBar::makeTechniqueButton() {
    auto* button = new QToolButton(this);
    button->setObjectName("view.technique_options");
    button->setToolTip(tr("Options of the technique"));
    button->setAccessibleName(tr("Options of the technique"));
    const auto paint = [this, button] { button->setIcon(desk_.theme.icon("options")); };
    paint();
    connect(&desk_.theme, &Theme::changed, button, paint);
    auto* sheet = new TechniqueOptions(desk_, this);
    connect(button, &QToolButton::clicked, sheet, [sheet, button] { sheet->openBelow(button); });
    return button;
}

QComboBox* ViewBar::makeBox(const QString& name, const QString& doc) {
    auto* box = new QComboBox(this);
    box->setAccessibleName(name);
    box->setToolTip(doc);
    box->setSizeAdjustPolicy(QComboBox::AdjustToContents);
    box->setMinimumWidth(72);
    box->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    return box;
}

QComboBox* ViewBar::makeOption(const char* option, const QString& name) {
    const auto section = std::ranges::find(sections(), "view", &Section::name);
    const Param& param = findParam(section->options, option, "option");
    QComboBox* box = makeBox(name, QString::fromStdString(param.doc));
    box->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
    for (const std::string& choice : param.choices) {
        QString text = choice == "srgb" ? QString("sRGB") : QString::fromStdString(choice);
        text[0] = choice == "srgb" ? text[0] : text[0].toUpper();
        box->addItem(text, QString::fromStdString(choice));
    }
    connect(box, &QComboBox::activated, this, [this, box, option, name] {
        desk_.workspace.setOption(name, "view", option, box->currentData().toString().toStdString());
        desk_.workspace.endGesture();
    });
    refresh_.push_back([this, box, option] {
        const QSignalBlocker quiet(box);
        box->setCurrentIndex(box->findData(
            QString::fromStdString(std::get<std::string>(optionOf(desk_.workspace.state(), "view", option)))));
    });
    return box;
}

void ViewBar::refillModels() {
    const State& state = desk_.workspace.state();
    const QSignalBlocker quiet_model(model_), quiet_against(against_);
    model_->clear();
    against_->clear();
    against_->addItem(tr("Reference (Monte Carlo)"), "reference");
    against_->insertSeparator(against_->count());
    for (std::size_t i = 0; i < state.models.size(); ++i) {
        const QIcon icon = dot(desk_.theme.seriesColor(state.models[i].color));
        model_->addItem(icon, titleOf(state.models[i].model.id));
        against_->addItem(icon, titleOf(state.models[i].model.id), QString("model %1").arg(i));
    }
    against_->insertSeparator(against_->count());
    for (const TechniqueEntry& entry : techniques()) {
        const QString id = QString::fromUtf8(entry.id.data(), static_cast<qsizetype>(entry.id.size()));
        against_->addItem(techniqueTitle(entry.id), "technique " + id);
    }
}

void ViewBar::refresh() {
    refillModels();
    const State& state = desk_.workspace.state();
    model_->setCurrentIndex(state.active);
    technique_->setCurrentIndex(technique_->findData(QString::fromStdString(state.technique)));
    const auto text = [&](const char* option) { return std::get<std::string>(optionOf(state, "view", option)); };
    const auto known = std::ranges::find(compare_values, text("compare"));
    compare_->setCurrent(static_cast<int>(known - std::begin(compare_values)));
    against_->setCurrentIndex(std::max(0, against_->findData(QString::fromStdString(text("against")))));
    against_->setEnabled(text("compare") != "none");
    auto_->setChecked(std::get<bool>(optionOf(state, "view", "auto_exposure")));
    exposure_->setValue(std::get<double>(optionOf(state, "view", "exposure")));
    difference_->setValue(std::get<double>(optionOf(state, "view", "difference_scale")));
    const bool difference = text("compare") == "difference";
    difference_->setVisible(difference);
    exposure_->setVisible(!difference);
    auto_->setVisible(!difference);
    for (const auto& each : refresh_) each();
}

}  // namespace searchlight::gui
