// A text field for programs: line numbers, an error at its line, indentation, completion of known names.
#pragma once

#include <QPlainTextEdit>
#include <optional>

#include "base/error.h"

class QCompleter;

namespace searchlight::gui {

class Theme;

class CodeEdit : public QPlainTextEdit {
    Q_OBJECT

public:
    explicit CodeEdit(Theme& theme, QWidget* parent = nullptr);

    /// Underlines what the error is about, and writes its message at the end of the line; none: no error.
    void setProblem(std::optional<Error> problem);
    const std::optional<Error>& problem() const { return problem_; }

    /// Puts the cursor there, 1-based; column 0: where the line's text begins.
    void goTo(int line, int column);

    int marginWidth() const;
    void paintMargin(QPaintEvent* event);

    /// The known names that begin as the word at the cursor does.
    QStringList completions() const;

Q_SIGNALS:
    void saveWished();

protected:
    void resizeEvent(QResizeEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    bool event(QEvent* event) override;

private:
    QString wordAtCursor() const;
    void complete(const QString& name);
    void offerCompletion(bool asked);
    void indent(bool more);
    void toggleComment();
    void mark();

    Theme& theme_;
    QWidget* margin_;
    QCompleter* completer_;
    std::optional<Error> problem_;
};

}  // namespace searchlight::gui
