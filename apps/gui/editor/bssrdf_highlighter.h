// Colours for the text of a model: the format's own lines, and GLSL within them.
#pragma once

#include <QHash>
#include <QSyntaxHighlighter>
#include <QTextCharFormat>

namespace searchlight::gui {

class Theme;

class BssrdfHighlighter : public QSyntaxHighlighter {
    Q_OBJECT

public:
    BssrdfHighlighter(Theme& theme, QTextDocument* document);

    /// What a word is: for tests, and for the tool tip.
    enum class Word { other, type, keyword, builtin, physics, global };
    static Word wordOf(const QString& word);

protected:
    void highlightBlock(const QString& text) override;

private:
    void takeColors();

    Theme& theme_;
    QHash<int, QTextCharFormat> words_;
    QTextCharFormat comment_, number_, section_, attribute_;
};

}  // namespace searchlight::gui
