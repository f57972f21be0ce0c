// Undo and redo, the marker of what is on disk, and the limit of steps.
#include "model/history.h"

#include "generators.h"
#include "pictures.h"

namespace probewarp {
namespace {

using testing::blank_document;
using testing::expect_always;
using testing::whole;

Document with_cells(int cells) {
    static const PicturePtr picture = testing::blank_picture(8, 8);
    Document document;
    document.picture = picture;
    document.mesh.cells = cells;
    return document;
}

int cells(const History& history) { return present(history).mesh.cells; }

TEST(History, GoesBackAndForth) {
    History history = new_history(with_cells(1), true);
    commit(history, with_cells(2), "two");
    commit(history, with_cells(3), "three");
    EXPECT_EQ(cells(history), 3);
    EXPECT_EQ(history.steps[2].label, "three");
    EXPECT_FALSE(redo(history));
    EXPECT_TRUE(undo(history));
    EXPECT_TRUE(undo(history));
    EXPECT_EQ(cells(history), 1);
    EXPECT_FALSE(undo(history));
    EXPECT_EQ(cells(history), 1);
    EXPECT_TRUE(redo(history));
    EXPECT_EQ(cells(history), 2);
}

TEST(History, ANewStepForgetsWhatWasUndone) {
    History history = new_history(with_cells(1), true);
    commit(history, with_cells(2), "");
    commit(history, with_cells(3), "");
    undo(history);
    commit(history, with_cells(4), "");
    EXPECT_FALSE(redo(history));
    EXPECT_EQ(cells(history), 4);
    undo(history);
    EXPECT_EQ(cells(history), 2);
}

TEST(History, HasNoStepsInWhichNothingHappens) {
    History history = new_history(with_cells(1), true);
    commit(history, with_cells(1), "nothing");
    EXPECT_EQ(history.steps.size(), 1u);
    commit(history, with_cells(2), "");
    undo(history);
    commit(history, with_cells(1), "nothing");
    EXPECT_TRUE(redo(history));  // nor does nothing forget what was undone
    EXPECT_EQ(cells(history), 2);
}

TEST(History, KnowsWhatIsOnDisk) {
    EXPECT_FALSE(is_saved(new_history(with_cells(1), false)));
    History history = new_history(with_cells(1), true);
    EXPECT_TRUE(is_saved(history));
    commit(history, with_cells(2), "");
    EXPECT_FALSE(is_saved(history));
    undo(history);
    EXPECT_TRUE(is_saved(history));
    redo(history);
    history.saved = history.at;
    undo(history);
    EXPECT_FALSE(is_saved(history));
    redo(history);
    EXPECT_TRUE(is_saved(history));
}

TEST(History, WhatIsOnDiskIsLostWithTheUndoneStep) {
    History history = new_history(with_cells(1), true);
    commit(history, with_cells(2), "");
    history.saved = history.at;
    undo(history);
    commit(history, with_cells(3), "");  // in the place of the saved step
    EXPECT_FALSE(is_saved(history));
    undo(history);
    EXPECT_FALSE(is_saved(history));
    redo(history);
    EXPECT_FALSE(is_saved(history));
}

TEST(History, ForgetsTheOldestBeyondItsLimit) {
    History history = new_history(with_cells(1), true);
    const int most = int(max_steps);
    for (int i = 2; i <= most; ++i) commit(history, with_cells(i), "");
    EXPECT_EQ(history.steps.size(), max_steps);
    EXPECT_EQ(history.saved, 0u);
    history.saved = 1;
    commit(history, with_cells(most + 1), "");  // forgets 1
    EXPECT_EQ(history.steps.size(), max_steps);
    EXPECT_EQ(cells(history), most + 1);
    while (undo(history)) {
    }
    EXPECT_EQ(cells(history), 2);
    EXPECT_TRUE(is_saved(history));  // the marker moved along
    while (redo(history)) {
    }
    commit(history, with_cells(most + 2), "");  // forgets the saved one
    while (undo(history)) EXPECT_FALSE(is_saved(history));
    EXPECT_FALSE(is_saved(history));
}

TEST(History, DoesWhatAListOfValuesWithAPlaceInItDoes) {
    expect_always("any mixture of commit, undo, redo and save", [] {
        History history = new_history(with_cells(0), true);
        std::vector<int> values{0};
        std::size_t at = 0;
        int on_disk = 0;
        for (int i = 1; i <= 60; ++i) switch (*whole(0, 5)) {
                case 0:
                    RC_ASSERT(undo(history) == (at > 0));
                    at -= at > 0;
                    break;
                case 1:
                    RC_ASSERT(redo(history) == (at + 1 < values.size()));
                    at += at + 1 < values.size();
                    break;
                case 2:
                    history.saved = history.at, on_disk = values[at];
                    break;
                default:
                    commit(history, with_cells(i), "");
                    values.resize(++at);
                    values.push_back(i);
            }
        RC_ASSERT(cells(history) == values[at]);
        RC_ASSERT(is_saved(history) == (values[at] == on_disk));
    });
}

}  // namespace
}  // namespace probewarp
