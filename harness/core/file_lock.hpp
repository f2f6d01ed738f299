// A lock of processes on a file. The kernel releases it when its process ends in any way.
#pragma once

#include <filesystem>

namespace attest {

// Opens the file for reading and writing, and locks it (flock) until the descriptor is closed.
// Makes the file if necessary. Does not wait. Returns -1 with errno: EWOULDBLOCK if another process
// holds the lock; ENOLCK, ENOSYS or EOPNOTSUPP if the file system has no locks.
//
// The holder may rename or remove the file: the returned file has the name `file` after it was
// locked.
int open_locked(const std::filesystem::path& file);

}  // namespace attest
