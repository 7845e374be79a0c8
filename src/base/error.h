// The one exception of the library. Bad input, a shader that does not compile, a device that is missing: all are an
// Error with a place and a hint; a programmer's error is an assert.
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

/// Decides the exit code of the command line: usage 2, input 3, device 4, interrupted 130.
enum class ErrorKind { usage, input, device, interrupted };

struct Error : std::exception {
    ErrorKind kind = ErrorKind::input;
    std::string file;     ///< what the user called it; empty when the input was no file
    int line = 0;         ///< 1-based; 0 when unknown
    int column = 0;       ///< 1-based; 0 when unknown
    std::string message;  ///< what is wrong, and what was expected
    std::string hint;     ///< what is valid, or how to mend it; may be empty

    Error(ErrorKind kind_, std::string message_, std::string hint_ = {});

    /// The same error with a place; parts already known stay.
    Error at(std::string_view file_, int line_ = 0, int column_ = 0) const;

    /// "file:line:column: message (hint)", as far as known.
    const char* what() const noexcept override { return text_.c_str(); }

private:
    void compose();
    std::string text_;
};

Error usageError(std::string message, std::string hint = {});
Error inputError(std::string message, std::string hint = {});
Error deviceError(std::string message, std::string hint = {});
Error interruptedError();

/// "unknown WHAT 'NAME'" with the nearest valid names (or all of them, if few) as the hint.
Error unknownName(ErrorKind kind, std::string_view what, std::string_view name, const std::vector<std::string>& valid);

}  // namespace searchlight
