#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nuvo::app {

/// JSON (RFC 8259) as text, two blanks a level. It holds the text only: nothing but the appending
/// takes memory, so running out of it is an exception like any other.
class JsonWriter {
  public:
    void begin_object() { open('{'); }
    void end_object() { close('}'); }
    void begin_array() { open('['); }
    void end_array() { close(']'); }
    /// The name of the member that the next value belongs to.
    void key(std::string_view name);

    void null() { literal("null"); }
    void value(bool b) { literal(b ? "true" : "false"); }
    void value(std::string_view text);
    void value(const char* text) { value(std::string_view(text)); }
    /// The shortest digits that read back as the same double; null where it is not finite.
    void value(double number);
    template <std::integral T>
    void value(T number) {
        literal(std::to_string(number));
    }
    void value(const std::vector<double>& numbers);
    /// null for none.
    template <typename T>
    void value(const std::optional<T>& content) {
        if (content) {
            value(*content);
        } else {
            null();
        }
    }

    template <typename T>
    void member(std::string_view name, const T& content) {
        key(name);
        value(content);
    }

    /// The document, ended by a newline. Every begin must have had its end.
    std::string text() const { return text_ + "\n"; }

  private:
    void open(char bracket);
    void close(char bracket);
    void literal(std::string_view text);
    void separate();
    void new_line();

    std::string text_;
    int level_ = 0;
    bool is_first_ = true;   // of its object or array
    bool has_name_ = false;  // a key waits for its value
};

/// `text` with every byte that is no part of valid UTF-8 replaced by U+FFFD.
std::string valid_utf8(std::string_view text);

}  // namespace nuvo::app
