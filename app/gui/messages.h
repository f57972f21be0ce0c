// Messages at the lower right: what happened, in a sentence that can be copied. Errors stay until they are
// read.
#pragma once

#include <string>
#include <vector>

namespace probewarp {

struct App;

enum class Tone { done, hint, error };

struct Message {
    std::string text;
    Tone tone = Tone::hint;
    double shown_at = 0;       ///< seconds of ImGui's clock
    unsigned long number = 0;  ///< tells it from every other
};

/// Says it; the same sentence again only begins anew.
void say(App& app, Tone tone, std::string text);

/// Draws the messages over the lower right of the canvas, beside a dialog where one is open, the newest
/// lowest, as many as there is room for; and forgets those that have been there long enough.
void draw_messages(App& app);

/// Within a dialog's window: messages of this frame stand aside of it.
void keep_messages_off(App& app);

/// Closes the newest error. Returns whether there was one.
bool close_error(App& app);

/// Seconds until a message moves or goes by itself; negative where none will.
double next_message_change(const App& app);

}  // namespace probewarp
