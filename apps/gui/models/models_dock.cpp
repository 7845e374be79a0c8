#include "gui/models/models_dock.h"

#include <QDockWidget>
#include <QFileDialog>
#include <QHeaderView>
#include <QMenu>
#include <QPainter>
#include <QSplitter>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "base/files.h"
#include "gui/models/checks_panel.h"
#include "gui/models/model_files.h"
#include "gui/models/model_status.h"
#include "gui/window/theme.h"
#include "model/model.h"

namespace searchlight::gui {

namespace {

enum Column { name_column, eye_column, solo_column, columns };

// What a slot is called: its title, and of a file its name.
QString titleOf(const ModelSlot& slot) {
    const std::string& id = slot.model.id;
    const QString title = modelTitle(id);
    if (!id.ends_with(".bssrdf") && !id.ends_with(".csv")) return title;
    const QString file = QString::fromStdString(id).section(QLatin1Char('/'), -1);
    return file == title ? title : QStringLiteral("%1  (%2)").arg(title, file);
}

QIcon swatch(const QColor& color, qreal ratio) {
    QPixmap picture(QSize(16, 16) * ratio);
    picture.setDevicePixelRatio(ratio);
    picture.fill(Qt::transparent);
    QPainter painter(&picture);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawRoundedRect(QRectF(2, 2, 12, 12), 3, 3);
    // A row that is chosen keeps it.
    QIcon icon(picture);
    icon.addPixmap(picture, QIcon::Selected);
    return icon;
}

class ModelsDock : public QWidget {
public:
    explicit ModelsDock(Desk& desk) : desk_(desk) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(Space::s, Space::s, Space::s, Space::s);
        layout->setSpacing(Space::s);
        layout->addLayout(makeButtons());
        auto* splitter = new QSplitter(Qt::Vertical, this);
        splitter->addWidget(makeList());
        splitter->addWidget(new ChecksPanel(desk, this));
        splitter->setStretchFactor(0, 3);
        splitter->setStretchFactor(1, 2);
        splitter->setChildrenCollapsible(false);
        layout->addWidget(splitter, 1);
        connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
            if (change.any({Part::models, Part::active})) fill();
        });
        connect(&ModelStatus::of(desk_.workspace), &ModelStatus::changed, this, [this] { fill(); });
        connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this] { fill(); });
        connect(&desk_.theme, &Theme::changed, this, [this] { fill(); });
        fill();
    }

private:
    QToolButton* button(const QString& text, const QString& icon, const QString& doc, const QString& name) {
        auto* made = new QToolButton(this);
        made->setObjectName(name);
        made->setText(text);
        made->setToolTip(doc);
        made->setAccessibleName(text);
        made->setAccessibleDescription(doc);
        made->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        const auto paint = [this, made, icon] { made->setIcon(desk_.theme.icon(icon)); };
        paint();
        connect(&desk_.theme, &Theme::changed, made, paint);
        return made;
    }

    QLayout* makeButtons() {
        auto* row = new QHBoxLayout;
        row->setSpacing(Space::xs);
        auto* add =
            button(tr("Add"), QStringLiteral("plus"), tr("Add a model to compare"), QStringLiteral("models.add"));
        add->setPopupMode(QToolButton::InstantPopup);
        auto* add_menu = new QMenu(add);
        for (const Model& model : shippedModels()) {
            QAction* action = add_menu->addAction(QString::fromStdString(model.file.title));
            action->setData(QString::fromStdString(model.id));
            connect(action, &QAction::triggered, this,
                    [this, id = QString::fromStdString(model.id)] { addModel(desk_.workspace, id); });
        }
        add_menu->addSeparator();
        add_menu->addAction(tr("Open file…"), this, [this] { openFile(); });
        add->setMenu(add_menu);
        auto* make = button(tr("New"), QStringLiteral("edit"), tr("Write a new model, beginning with a template"),
                            QStringLiteral("models.new"));
        make->setPopupMode(QToolButton::InstantPopup);
        auto* make_menu = new QMenu(make);
        int count = 0;
        for (const ModelTemplate& each : modelTemplates()) {
            if (count++ == 2) make_menu->addSection(tr("As a copy of"));
            connect(make_menu->addAction(each.title), &QAction::triggered, this, [this, id = each.id] { makeNew(id); });
        }
        make->setMenu(make_menu);
        auto* edit = button(tr("Edit"), QStringLiteral("editor"), tr("Show the text of the model"),
                            QStringLiteral("models.edit"));
        connect(edit, &QToolButton::clicked, this, [this] { raiseDock(this, QStringLiteral("editor")); });
        auto* reload =
            button({}, QStringLiteral("reload"), tr("Read the model's file again"), QStringLiteral("models.reload"));
        reload->setAccessibleName(tr("Reload"));
        connect(reload, &QToolButton::clicked, this, [this] {
            desk_.workspace.noteModelFile(QString::fromStdString(desk_.workspace.state().activeModel().model.id));
        });
        auto* remove =
            button({}, QStringLiteral("minus"), tr("Take the model off the list"), QStringLiteral("models.remove"));
        remove->setAccessibleName(tr("Remove"));
        connect(remove, &QToolButton::clicked, this, [this] { removeActive(); });
        for (QToolButton* each : {add, make, edit}) row->addWidget(each);
        row->addStretch(1);
        row->addWidget(reload);
        row->addWidget(remove);
        return row;
    }

    QWidget* makeList() {
        list_ = new QTreeWidget(this);
        list_->setObjectName(QStringLiteral("models.list"));
        list_->setAccessibleName(tr("Models"));
        list_->setColumnCount(columns);
        list_->setHeaderHidden(true);
        list_->setRootIsDecorated(false);
        list_->setFrameShape(QFrame::NoFrame);
        list_->header()->setStretchLastSection(false);
        list_->header()->setSectionResizeMode(name_column, QHeaderView::Stretch);
        for (const int column : {eye_column, solo_column}) {
            list_->header()->setSectionResizeMode(column, QHeaderView::Fixed);
            list_->header()->resizeSection(column, Space::row);
        }
        connect(list_, &QTreeWidget::itemClicked, this,
                [this](QTreeWidgetItem* item, int column) { clicked(list_->indexOfTopLevelItem(item), column); });
        connect(list_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
            if (item && !filling_) activate(list_->indexOfTopLevelItem(item));
        });
        connect(list_, &QTreeWidget::itemDoubleClicked, this, [this](QTreeWidgetItem*, int column) {
            if (column == name_column) raiseDock(this, QStringLiteral("editor"));
        });
        return list_;
    }

    void fill() {
        filling_ = true;
        const State& state = desk_.workspace.state();
        const ModelStatus& status = ModelStatus::of(desk_.workspace);
        list_->clear();
        for (std::size_t i = 0; i < state.models.size(); ++i) {
            const ModelSlot& slot = state.models[i];
            auto* item = new QTreeWidgetItem(list_);
            const Error* problem = status.problem(slot.model.id);
            item->setText(name_column, titleOf(slot));
            item->setIcon(name_column, problem ? desk_.theme.icon(QStringLiteral("warning"))
                                               : swatch(desk_.theme.seriesColor(slot.color), devicePixelRatioF()));
            const bool solo = state.solo == static_cast<int>(i);
            item->setIcon(eye_column, desk_.theme.icon(QLatin1String(slot.visible ? "eye" : "eye_off")));
            item->setIcon(solo_column, desk_.theme.icon(QLatin1String(solo ? "solo" : "point")));
            QString tip = QString::fromStdString(slot.model.id);
            if (problem) {
                tip += QLatin1Char('\n') + QString::fromUtf8(problem->what());
                item->setForeground(name_column, desk_.theme.colors().error);
            } else if (!slot.visible) {
                item->setForeground(name_column, desk_.theme.colors().muted);
            }
            item->setToolTip(name_column, tip);
            item->setToolTip(eye_column, slot.visible ? tr("Visible: click to hide") : tr("Hidden: click to show"));
            item->setToolTip(solo_column,
                             solo ? tr("Alone: click to show all") : tr("Click to show alone, channel by channel"));
            item->setData(eye_column, Qt::AccessibleTextRole, slot.visible ? tr("visible") : tr("hidden"));
            item->setData(solo_column, Qt::AccessibleTextRole, solo ? tr("solo") : tr("not solo"));
            item->setSizeHint(name_column, QSize(0, Space::row));
            if (static_cast<int>(i) == state.active) list_->setCurrentItem(item);
        }
        filling_ = false;
    }

    void activate(int index) {
        desk_.workspace.edit(tr("Active model"), {}, [index](State& state) { state.active = index; });
    }

    void clicked(int index, int column) {
        if (column == eye_column)
            desk_.workspace.edit(tr("Visibility"), {}, [index](State& state) {
                bool& visible = state.models[static_cast<std::size_t>(index)].visible;
                visible = !visible;
            });
        if (column == solo_column)
            desk_.workspace.edit(tr("Solo"), {},
                                 [index](State& state) { state.solo = state.solo == index ? -1 : index; });
    }

    void removeActive() {
        if (desk_.workspace.state().models.size() < 2)
            return desk_.notices.post(Notices::Level::info, tr("The last model stays: add another first."));
        desk_.workspace.edit(tr("Remove model"), {}, [](State& state) {
            state.models.erase(state.models.begin() + state.active);
            if (state.solo == state.active) state.solo = -1;
            if (state.solo > state.active) --state.solo;
        });
    }

    void openFile() {
        const QString path =
            QFileDialog::getOpenFileName(this, tr("Open a model"), {}, tr("Models (*.bssrdf *.csv);;All files (*)"));
        if (!path.isEmpty()) addModel(desk_.workspace, path);
    }

    void makeNew(const QString& template_id) {
        try {
            addNewModel(desk_.workspace, template_id);
            raiseDock(this, QStringLiteral("editor"));
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
    }

    Desk& desk_;
    QTreeWidget* list_ = nullptr;
    bool filling_ = false;
};

}  // namespace

QWidget* makeModelsDock(Desk& desk) { return new ModelsDock(desk); }

void addModel(Workspace& workspace, const QString& id) {
    workspace.edit(QObject::tr("Add model"), {}, [&](State& state) {
        state.models.push_back(newSlot(state, id.toStdString()));
        state.active = static_cast<int>(state.models.size()) - 1;
    });
}

QString addNewModel(Workspace& workspace, const QString& template_id) {
    const bool blank = template_id == QLatin1String("radial") || template_id == QLatin1String("directional");
    const QString path = freeModelPath(blank ? QStringLiteral("my_model") : QStringLiteral("my_") + template_id);
    const QString stem = path.section(QLatin1Char('/'), -1).section(QLatin1Char('.'), 0, 0);
    QString title = stem;
    title.replace(QLatin1Char('_'), QLatin1Char(' '));
    title[0] = title[0].toUpper();
    writeFile(path.toStdString(), newModelText(template_id, title).toStdString());
    addModel(workspace, path);
    return path;
}

void raiseDock(QWidget* widget, const QString& id) {
    const QString name = QStringLiteral("dock.") + id;
    auto* dock = widget->window()->findChild<QDockWidget*>(name);
    // A dock that was popped out is a window of its own.
    for (QWidget* host = widget; !dock && host; host = host->parentWidget()) dock = host->findChild<QDockWidget*>(name);
    if (!dock) return;
    dock->show();
    dock->raise();
    if (dock->widget()) dock->widget()->setFocus();
}

}  // namespace searchlight::gui
