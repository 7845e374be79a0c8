// Small pictures side by side, each with a title and a note.
#pragma once

#include <QImage>
#include <QList>
#include <QWidget>

namespace searchlight::gui {

class Theme;

class PictureRow : public QWidget {
    Q_OBJECT

public:
    explicit PictureRow(Theme& theme, QWidget* parent = nullptr);

    struct Panel {
        QString title, note;
        QImage picture;
    };
    void setPanels(QList<Panel> panels);
    const QList<Panel>& panels() const { return panels_; }

    QSize minimumSizeHint() const override { return {260, 120}; }

protected:
    void paintEvent(QPaintEvent*) override;

private:
    Theme& theme_;
    QList<Panel> panels_;
};

}  // namespace searchlight::gui
