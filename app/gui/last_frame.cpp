#include "gui/last_frame.h"

#include <new>
#include <span>
#include <utility>

namespace probewarp {

namespace {

template <class T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
    const auto more = std::as_bytes(values);
    bytes.insert(bytes.end(), more.begin(), more.end());
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    append(bytes, std::span<const T>(&value, 1));
}

}  // namespace

bool LastFrame::differs(const ImDrawData& data) try {
    std::vector<std::byte> drawn;
    drawn.reserve(drawn_.size());
    append(drawn, data.DisplaySize);
    append(drawn, data.FramebufferScale);
    for (const ImDrawList* list : std::span(data.CmdLists, std::size_t(data.CmdListsCount))) {
        append(drawn, std::span<const ImDrawVert>(list->VtxBuffer.begin(), list->VtxBuffer.end()));
        append(drawn, std::span<const ImDrawIdx>(list->IdxBuffer.begin(), list->IdxBuffer.end()));
        for (const ImDrawCmd& command : list->CmdBuffer) {  // one by one: between them there may be anything
            append(drawn, command.ClipRect);
            append(drawn, command.TextureId);
            append(drawn, command.VtxOffset);
            append(drawn, command.IdxOffset);
            append(drawn, command.ElemCount);
        }
    }
    if (drawn == drawn_) return false;
    drawn_ = std::move(drawn);
    return true;
} catch (const std::bad_alloc&) {  // rather drawn once too often
    drawn_.clear();
    return true;
}

}  // namespace probewarp
