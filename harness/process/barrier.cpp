#include "harness/process/barrier.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "harness/core/sanitizers.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// ---- Landlock -----------------------------------------------------------------------------------

// From linux/landlock.h of Linux 6.12; the header of Debian 12 is older.
struct RulesetAttributes {
  std::uint64_t handled_access_fs, handled_access_net, scoped;
};
constexpr std::uint64_t scope_abstract_unix_socket = 1u << 0, scope_signal = 1u << 1;
constexpr std::uint64_t refer = 1u << 13, truncate_file = 1u << 14;
constexpr int abi_of_refer = 2, abi_of_truncate = 3, abi_of_scopes = 6;

// The version of Landlock in this kernel; 0 or less: none.
int landlock_abi() {
  static const int abi = static_cast<int>(
      ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION));
  return abi;
}

// The rights that the barrier takes away. Those to list a folder and to execute a file stay.
std::uint64_t rights_of_file() {
  return LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE |
         (landlock_abi() >= abi_of_truncate ? truncate_file : 0);
}

std::uint64_t rights_of_folder() {
  return rights_of_file() | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
         LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
         LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
         LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM |
         (landlock_abi() >= abi_of_refer ? refer : 0);
}

// Allows access to what is at and below `path`. A path that cannot be opened stays forbidden.
void allow(int rules, const fs::path& path, std::uint64_t rights) {
  const int opened = ::open(path.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC);
  if (opened < 0) return;
  std::error_code ignored;
  landlock_path_beneath_attr rule{};
  rule.allowed_access = rights & (fs::is_directory(path, ignored) ? ~0ull : rights_of_file());
  rule.parent_fd = opened;
  ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  ::close(opened);
}

bool is_above(const fs::path& folder, const fs::path& path) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

// Landlock can only allow. So this allows all neighbours of the folders on the way to the hidden
// ones. Symbolic links need no rule, because Landlock looks at what they lead to.
void allow_all_but(const std::vector<fs::path>& hidden, const fs::path& path, int rules) {
  const auto leads_there = [&](const fs::path& each) { return is_above(path, each); };
  if (std::find(hidden.begin(), hidden.end(), path) != hidden.end()) return;
  if (std::none_of(hidden.begin(), hidden.end(), leads_there)) {
    return allow(rules, path, rights_of_folder());
  }
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(path, unreadable)) {
    if (!entry.is_symlink()) allow_all_but(hidden, entry.path(), rules);
  }
}

// Through these files root can stop, limit or kill any process. Some programs read their own limits
// there.
constexpr const char* control_groups = "/sys/fs/cgroup";

// Through the devices of disks root can read and change every file.
std::vector<std::string> disks() {
  std::vector<std::string> found;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator("/dev", unreadable)) {
    std::error_code ignored;
    if (entry.is_block_file(ignored)) found.push_back(entry.path());
  }
  return found;
}

std::vector<fs::path> existing(const std::vector<std::string>& paths) {
  std::vector<fs::path> found;
  for (const std::string& path : paths) {
    std::error_code missing;
    const fs::path real = fs::canonical(path, missing);
    if (!missing) found.push_back(real);
  }
  return found;
}

// ---- system calls -------------------------------------------------------------------------------

// A filter that refuses to change the limits of other processes, which a user may do to all of his
// processes. Landlock does not refuse that. Empty: errno has the reason.
std::string filter_of_calls() {
  std::array<int, 2> pipe{-1, -1};  // not a file, because `ulimit -f` may forbid to write one
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return {};
  const scmp_filter_ctx filter = ::seccomp_init(SCMP_ACT_ALLOW);
  // The first argument is a process; 0: its own.
  const scmp_arg_cmp of_others{0, SCMP_CMP_NE, 0, 0};
  const bool is_made = filter != nullptr &&
                       ::seccomp_rule_add_array(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(prlimit64),
                                                1, &of_others) == 0 &&
                       ::seccomp_export_bpf(filter, pipe[1]) == 0;
  const int reason = errno;
  ::seccomp_release(filter);
  ::close(pipe[1]);
  std::string program(PIPE_BUF, '\0');
  const ssize_t size = is_made ? ::read(pipe[0], program.data(), program.size()) : 0;
  ::close(pipe[0]);
  program.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  errno = reason;
  return program;
}

void enter_filter(const std::string& program) {
  std::vector<sock_filter> instructions(program.size() / sizeof(sock_filter));
  std::memcpy(instructions.data(), program.data(), instructions.size() * sizeof(sock_filter));
  const sock_fprog filter{static_cast<unsigned short>(instructions.size()), instructions.data()};
  ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter);
}

// ---- capabilities -------------------------------------------------------------------------------

// What lets root change other processes, the kernel, the clock, or its own limits.
constexpr std::array<unsigned, 15> lifting_capabilities{
    CAP_SYS_RESOURCE, CAP_SYS_PTRACE, CAP_SYS_ADMIN, CAP_SYS_MODULE,   CAP_SYS_RAWIO,
    CAP_SYS_BOOT,     CAP_SYS_TIME,   CAP_KILL,      CAP_MKNOD,        CAP_BPF,
    CAP_PERFMON,      CAP_SETPCAP,    CAP_MAC_ADMIN, CAP_MAC_OVERRIDE, CAP_CHECKPOINT_RESTORE};

void drop_capabilities() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> sets{};
  if (::syscall(SYS_capget, &header, sets.data()) != 0) return;
  for (const unsigned capability : lifting_capabilities) {
    ::prctl(PR_CAPBSET_DROP, capability);  // an ordinary user has none to drop
    auto& set = sets.at(CAP_TO_INDEX(capability));
    const std::uint32_t kept = ~CAP_TO_MASK(capability);
    set.effective &= kept;
    set.permitted &= kept;
    set.inheritable &= kept;
  }
  ::syscall(SYS_capset, &header, sets.data());
}

}  // namespace

BarrierParts barrier_parts() { return {landlock_abi() >= 1, landlock_abi() >= abi_of_scopes}; }

std::vector<std::string> missing_parts(const BarrierParts& parts) {
  std::vector<std::string> names;
  if (!parts.files) names.emplace_back("files of the suite");
  if (!parts.signals) names.emplace_back("signals");
  return names;
}

Result<Barrier> Barrier::make(const BarrierOptions& options) {
  const auto cannot = [] {
    return fail(fmt::format("cannot make the barrier around a port: {}", std::strerror(errno)));
  };
  std::string filter = filter_of_calls();
  if (filter.empty()) return cannot();
  if (landlock_abi() < 1) return Barrier(-1, std::move(filter));
  const bool has_scopes = landlock_abi() >= abi_of_scopes;
  const RulesetAttributes attributes{rights_of_folder(), 0,
                                     has_scopes ? scope_abstract_unix_socket | scope_signal : 0};
  // Older kernels know only the first member.
  const std::size_t size = has_scopes ? sizeof attributes : sizeof attributes.handled_access_fs;
  const int rules = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &attributes, size, 0));
  if (rules < 0) return cannot();
  Barrier barrier(rules, std::move(filter));
  std::vector<std::string> hidden = options.hidden, readable = options.readable;
  for (const std::string& disk : disks()) hidden.push_back(disk);
  hidden.emplace_back(control_groups);
  readable.emplace_back(control_groups);
  allow_all_but(existing(hidden), "/", rules);
  for (const fs::path& path : existing(readable)) {
    allow(rules, path, LANDLOCK_ACCESS_FS_READ_FILE);
  }
  return barrier;
}

Barrier::Barrier(Barrier&& other) noexcept
    : rules_(std::exchange(other.rules_, -1)), filter_(std::move(other.filter_)) {}

Barrier::~Barrier() {
  if (rules_ >= 0) ::close(rules_);
}

void Barrier::enter() const {
  // Otherwise a program with the set-user-ID bit would be outside.
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (rules_ >= 0 && ::syscall(SYS_landlock_restrict_self, rules_, 0) != 0) {
    fmt::print(stderr, "attest: cannot enter the barrier: {}\n", std::strerror(errno));
    ::_exit(EXIT_FAILURE);
  }
  drop_capabilities();
  enter_filter(filter_);
  ::prctl(PR_SET_DUMPABLE, 1);  // for a debugger: this memory has nothing to hide
}

void hide_memory() {
  // LeakSanitizer reads the memory of its own process as a debugger does.
  if (!built_with_sanitizers) ::prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace attest
