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
    double shown_at = 0;  ///< seconds of ImGui's clock
};

/// Says it; the same sentence again only begins anew.
void say(App& app, Tone tone, std::string text);

/// Draws the messages and forgets those that have been there long enough.
void draw_messages(App& app);

/// Seconds until a message moves or goes by itself; negative where none will.
double next_message_change(const App& app);

}  // namespace probewarp
