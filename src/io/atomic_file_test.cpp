// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "io/file_bytes.h"
#include "io/test_files.h"

namespace gischt {
namespace {

void write_text(const std::string& path, const std::string& text) {
    AtomicFile file(path);
    file.write(std::span<const char>(text));
    file.commit();
}

TEST(AtomicFile, MakesTheFolderAndReplacesWhatWasThere) {
    const TestFolder folder("atomic");
    const std::string path = folder.file("a/b/c.txt");
    write_text(path, "one");
    write_text(path, "two");
    EXPECT_EQ(read_bytes(path), "two");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("a/b")), {}), 1);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const TestFolder folder("atomic");
    try {
        AtomicFile file(folder.file("a.exr"));
        file.write(std::span<const char>("half a", 6));
        EXPECT_EQ(folder.count(), 1);
        EXPECT_EQ(std::filesystem::path(file.temporary()).extension(), ".exr");
        throw 1;
    } catch (int) {
    }
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, KeepsTheOldFileWhenTheNewOneFails) {
    const TestFolder folder("atomic");
    write_text(folder.file("a"), "old");
    { const AtomicFile file(folder.file("a")); }
    EXPECT_EQ(read_bytes(folder.file("a")), "old");
    EXPECT_EQ(folder.count(), 1);
}

// A limit on the size of files stands for a full disk: the system then says EFBIG.
TEST(AtomicFile, ReportsAFullDiskAndLeavesNothing) {
    const TestFolder folder("atomic");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const Outcome result = outcome([&] { write_text(folder.file("a"), std::string(9999, 'x')); });
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    EXPECT_EQ(result, Outcome::Resource);
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, RefusesFoldersDevicesAndPathsThroughFiles) {
    const TestFolder folder("atomic");
    EXPECT_EQ(outcome([&] { write_text(folder.file("."), "x"); }), Outcome::Usage);
    EXPECT_EQ(outcome([&] { write_text("/dev/null", "x"); }), Outcome::Usage);
    write_text(folder.file("a"), "x");
    EXPECT_EQ(outcome([&] { write_text(folder.file("a/b"), "x"); }), Outcome::Resource);
    EXPECT_EQ(outcome([&] { write_text("/proc/nowhere/b", "x"); }), Outcome::Resource);
}

// A process that ends without a word, after it has begun a file.
int killed_writer(const std::string& path) {
    const pid_t child = fork();
    if (child == 0) {
        AtomicFile file(path);
        file.write(std::span<const char>("half", 4));
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

TEST(AtomicFile, RemovesWhatKilledProcessesLeft) {
    const TestFolder folder("atomic");
    ASSERT_EQ(killed_writer(folder.file("a.vdb")), SIGKILL);
    ASSERT_EQ(killed_writer(folder.file("b.png")), SIGKILL);
    EXPECT_EQ(folder.count(), 1) << "the second has taken away what the first left";
    // Not what lives: a file of our own, and what others have named alike.
    const AtomicFile open(folder.file("c"));
    put(folder.file(".x.gischt-1-0.vdb"), "of a process that runs");
    put(folder.file(".x.gischt-999999999.vdb"), "without a count");
    put(folder.file("x.gischt-999999999-0.vdb"), "not hidden");
    write_text(folder.file("a.vdb"), "whole");
    EXPECT_EQ(folder.count(), 5);
    EXPECT_EQ(read_bytes(folder.file("a.vdb")), "whole");
    EXPECT_TRUE(std::filesystem::exists(open.temporary()));
}

TEST(AtomicFile, LeavesFilesThatAreLocked) {
    const TestFolder folder("atomic");
    const std::string path = folder.file(".x.gischt-999999999-0.vdb");  // beyond any process id
    put(path, "of a process on another machine");
    const int descriptor = open(path.c_str(), O_RDONLY);
    ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
    remove_orphans(folder.file("."));
    EXPECT_EQ(folder.count(), 1);
    close(descriptor);
    remove_orphans(folder.file("."));
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, FollowsSymbolicLinks) {
    const TestFolder folder("atomic");
    std::filesystem::create_symlink("real", folder.file("link"));
    write_text(folder.file("link"), "x");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
    EXPECT_EQ(read_bytes(folder.file("real")), "x");
}

TEST(AtomicFile, TakesTheLongestNames) {
    const TestFolder folder("atomic");
    const std::string name = std::string(250, 'n') + ".exr";
    write_text(folder.file(name), "x");
    EXPECT_EQ(read_bytes(folder.file(name)), "x");
}

}  // namespace
}  // namespace gischt
