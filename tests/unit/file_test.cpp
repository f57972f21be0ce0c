// Reading and writing whole files: what is refused, and that a failed save leaves the old file alone.
#include "io/file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "pictures.h"
#include "temporary_folder.h"

namespace probewarp {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

std::vector<std::byte> bytes_of(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

mode_t mode_of(const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
}

struct FileTest : ::testing::Test {
    TemporaryFolder folder;
    fs::path path = folder.path / "file";

    void put(std::string_view text) const { std::ofstream(path, std::ios::binary) << text; }
    std::string got() const {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(FileTest, ReadsWhatWasWritten) {
    std::vector<std::byte> all;
    for (int i = 0; i < 100'000; ++i) all.push_back(std::byte(i * 7 % 256));
    write_file(path, all);
    EXPECT_EQ(read_file(path), all);
}

TEST_F(FileTest, ReadsUpToTheLimitAndNoFurther) {
    put("12345");
    EXPECT_EQ(read_file(path, 5).size(), 5u);
    EXPECT_THAT(error_of([&] { read_file(path, 4); }),
                HasSubstr("file: is 5 bytes long; expected at most 4"));
}

TEST_F(FileTest, RefusesToReadWhatIsNoFile) {
    EXPECT_THAT(error_of([&] { read_file(path); }), HasSubstr("file: cannot be opened: No such file"));
    EXPECT_THAT(error_of([&] { read_file(folder.path); }), HasSubstr("is a folder; expected a file"));
    EXPECT_THAT(error_of([&] { read_file("/dev/zero"); }), HasSubstr("/dev/zero: is a device"));
    put("");
    EXPECT_THAT(error_of([&] { read_file(path); }), HasSubstr("is empty"));
}

TEST_F(FileTest, NeverWaitsForAFifo) {
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    ::alarm(60);  // rather than hanging the whole run
    EXPECT_THAT(error_of([&] { read_file(path); }), HasSubstr("is a pipe (FIFO)"));
    EXPECT_THAT(error_of([&] { write_file(path, bytes_of("x")); }), HasSubstr("it is a pipe (FIFO)"));
    ::alarm(0);
}

TEST_F(FileTest, MessagesHoldNoControlCharacter) {
    const std::string error = error_of([&] { read_file(folder.path / "a\nb\x1b[31m\xff\xc2\x9b\xc3\xa4"); });
    EXPECT_THAT(error, HasSubstr("a?b?[31m???\xc3\xa4: cannot"));
}

TEST_F(FileTest, KeepsThePermissionsOfTheOldFileAndGivesANewOneTheUsual) {
    const mode_t umask = ::umask(027);
    write_file(path, bytes_of("new"));
    EXPECT_EQ(mode_of(path), 0640u);
    ASSERT_EQ(::chmod(path.c_str(), 0604), 0);
    write_file(path, bytes_of("newer"));
    ::umask(umask);
    EXPECT_EQ(mode_of(path), 0604u);
    EXPECT_EQ(got(), "newer");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, WritesThroughSymbolicLinks) {
    const fs::path link = folder.path / "link", second = folder.path / "second";
    fs::create_directory(folder.path / "sub");
    path = folder.path / "sub" / "target";
    fs::create_symlink("sub/target", link);
    fs::create_symlink(link, second);
    write_file(second, bytes_of("through a link to nothing yet"));
    EXPECT_EQ(got(), "through a link to nothing yet");
    write_file(second, bytes_of("again"));
    EXPECT_EQ(got(), "again");
    EXPECT_TRUE(fs::is_symlink(link) && fs::is_symlink(second));
    EXPECT_EQ(names_in(folder.path / "sub"), std::vector<std::string>{"target"});

    fs::create_symlink("round", folder.path / "round");
    EXPECT_THAT(error_of([&] { write_file(folder.path / "round", bytes_of("x")); }),
                HasSubstr("Too many levels"));
}

// Never a device of the system: were the check gone, a test run by root would put a file in its place.
TEST_F(FileTest, RefusesToWriteOverWhatIsNoFile) {
    EXPECT_THAT(
        error_of([&] { write_file(folder.path, bytes_of("x")); }),
        ::testing::AllOf(HasSubstr("cannot save " + folder.path.string()), HasSubstr("it is a folder")));
    EXPECT_THAT(error_of([&] { write_file(folder.path / "no" / "file", bytes_of("x")); }),
                HasSubstr("No such file or directory"));
    EXPECT_THAT(error_of([&] { write_file("", bytes_of("x")); }), HasSubstr("it names no file"));
    EXPECT_TRUE(names_in(folder.path).empty());
}

TEST_F(FileTest, InPortionsNothingIsSeenBeforeTheEnd) {
    put("old");
    {
        FileWriter writer(path);
        writer.write(bytes_of("one "));
        writer.write(bytes_of("two"));
        EXPECT_EQ(got(), "old");
    }
    EXPECT_EQ(got(), "old") << "given up";
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
    FileWriter writer(path);
    writer.write(bytes_of("one long beginning"));
    writer.restart();
    writer.write(bytes_of("two, "));
    writer.write(bytes_of("three"));
    EXPECT_EQ(got(), "old");
    writer.finish();
    EXPECT_EQ(got(), "two, three");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
    EXPECT_THAT(error_of([&] { FileWriter(folder.path / "no" / "file"); }), HasSubstr("cannot save"));
}

TEST_F(FileTest, LeavesAReadOnlyFileAlone) {
    put("old");
    ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
    const uid_t self = ::geteuid();
    if (self == 0) {  // root may write any file: the write is then somebody else's, in a folder of his own
        constexpr uid_t nobody = 65534;
        for (const auto& owned : {folder.path, path})
            ASSERT_EQ(::chown(owned.c_str(), nobody, gid_t(-1)), 0) << owned;
        ASSERT_EQ(::seteuid(nobody), 0);
    }
    const std::string error = error_of([&] { write_file(path, bytes_of("new")); });
    ASSERT_EQ(::seteuid(self), 0);
    EXPECT_THAT(error, HasSubstr("Permission denied"));
    EXPECT_EQ(got(), "old");
}

TEST_F(FileTest, AFailedWriteKeepsTheOldFileAndLeavesNoOther) {
    put("old");
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{1000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string error = error_of([&] { write_file(path, std::vector<std::byte>(100'000)); });
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_THAT(error, HasSubstr("cannot save " + path.string() + ": File too large"));
    EXPECT_EQ(got(), "old");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, TakesNamesOfTheGreatestLength) {
    path = folder.path / std::string(255, 'n');
    write_file(path, bytes_of("x"));
    EXPECT_EQ(got(), "x");
    EXPECT_EQ(names_in(folder.path).size(), 1u);
}

}  // namespace
}  // namespace probewarp
