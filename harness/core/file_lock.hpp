// A lock that a process holds on a file. The kernel releases it when the process ends in any way.
#pragma once

#include <filesystem>

namespace attest {

// Opens the file for reading and writing, and locks it (flock) until the returned descriptor is
// closed. Makes the file if necessary. Does not wait for the lock. Returns -1 with errno if it
// fails: EWOULDBLOCK if another descriptor holds the lock; ENOLCK, ENOSYS or EOPNOTSUPP if the file
// system has no locks; an error of open().
//
// The holder of the lock may rename or remove the file. So this function checks, once it has the
// lock, that the locked file still has the name `file`. If not, it tries again.
int open_locked(const std::filesystem::path& file);

}  // namespace attest
