/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: fail. Each port attacks what is outside its process, and its outputs are right only if
 * the attack ATTACK succeeds. So a pass shows a hole in the barrier. VICTIM names the attacked file
 * (a golden). Attacked processes are those above the port's: its worker, the worker's guard, and
 * attest.
 *
 *     reads_file, writes_file, removes_file, renames_file    VICTIM, by its path
 *     reads_by_link, reads_by_root, reads_by_program         VICTIM, in three other ways
 *     reads_memory, opens_memory, traces                     of the processes above
 *     stops, kills, queues                                   signals to the processes above
 *     raises_files, raises_memory, raises_of_parent          limits
 *     freezes                                                writes a file of control groups
 *     reads_disk                                             the device of a disk
 *     makes_shared                       256 MiB of memory that 20 processes share */
#define _GNU_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../wrapper.h"

static const char* victim(void) {
  const char* path = getenv("VICTIM");
  return path != NULL ? path : "";
}

static int opens(const char* path, int flags) {
  const int file = open(path, flags);
  if (file >= 0) close(file);
  return file >= 0;
}

static int reads_file(void) { return opens(victim(), O_RDONLY); }
static int writes_file(void) { return opens(victim(), O_WRONLY); }
static int removes_file(void) { return unlink(victim()) == 0; }

static int renames_file(void) {
  char other[4096];
  snprintf(other, sizeof other, "%s.moved", victim());
  return rename(victim(), other) == 0;
}

static int reads_by_link(void) {
  char link[64];
  snprintf(link, sizeof link, "attack_link_%d", (int)getpid());
  const int made = symlink(victim(), link) == 0;
  const int read = made && opens(link, O_RDONLY);
  unlink(link);
  return read;
}

static int reads_by_root(void) {
  char path[4096];
  snprintf(path, sizeof path, "/proc/self/root%s", victim());
  return opens(path, O_RDONLY);
}

static int reads_by_program(void) {
  char command[4096];
  snprintf(command, sizeof command, "cat '%s' >/dev/null 2>&1", victim());
  return system(command) == 0;
}

static pid_t parent_of(pid_t process) {
  char path[64];
  int parent = 0;
  snprintf(path, sizeof path, "/proc/%d/stat", (int)process);
  FILE* file = fopen(path, "r");
  if (file == NULL) return 0;
  if (fscanf(file, "%*d %*s %*c %d", &parent) != 1) parent = 0;
  fclose(file);
  return parent;
}

/* Calls `attack` with the three processes above this one, until it succeeds. */
static int on_any_above(int (*attack)(pid_t)) {
  pid_t process = getpid();
  for (int i = 0; i < 3; i++) {
    process = parent_of(process);
    if (process <= 1) return 0;
    if (attack(process)) return 1;
  }
  return 0;
}

static int reads_memory_of(pid_t process) {
  char path[64];
  unsigned long begin = 0;
  snprintf(path, sizeof path, "/proc/%d/maps", (int)process);
  FILE* maps = fopen(path, "r");
  if (maps == NULL) return 0;
  if (fscanf(maps, "%lx", &begin) != 1) begin = 0;
  fclose(maps);
  char bytes[16];
  const struct iovec here = {bytes, sizeof bytes}, there = {(void*)begin, sizeof bytes};
  return process_vm_readv(process, &here, 1, &there, 1, 0) > 0;
}
static int reads_memory(void) { return on_any_above(reads_memory_of); }

static int opens_memory_of(pid_t process) {
  char path[64];
  snprintf(path, sizeof path, "/proc/%d/mem", (int)process);
  return opens(path, O_RDWR);
}
static int opens_memory(void) { return on_any_above(opens_memory_of); }

static int traces_one(pid_t process) {
  if (ptrace(PTRACE_SEIZE, process, NULL, NULL) != 0) return 0;
  ptrace(PTRACE_DETACH, process, NULL, NULL);
  return 1;
}
static int traces(void) { return on_any_above(traces_one); }

static int stops_one(pid_t process) { return kill(process, SIGSTOP) == 0; }
static int stops(void) { return on_any_above(stops_one); }
static int kills_one(pid_t process) { return kill(process, SIGKILL) == 0; }
static int kills(void) { return on_any_above(kills_one); }
static int queues_one(pid_t process) {
  const union sigval none = {0};
  return sigqueue(process, SIGTERM, none) == 0;
}
static int queues(void) { return on_any_above(queues_one); }

static int raises(pid_t process, __rlimit_resource_t resource) {
  struct rlimit limit = {RLIM_INFINITY, RLIM_INFINITY};
  return prlimit(process, resource, &limit, NULL) == 0;
}
static int raises_files(void) { return raises(0, RLIMIT_FSIZE); }
static int raises_memory(void) { return raises(0, RLIMIT_DATA); }
static int raises_of(pid_t process) { return raises(process, RLIMIT_CPU); }
static int raises_of_parent(void) { return on_any_above(raises_of); }

/* A control group can stop or kill any process of its user. */
static int freezes(void) {
  return opens("/sys/fs/cgroup/cgroup.procs", O_WRONLY) ||
         opens("/sys/fs/cgroup/freezer/cgroup.procs", O_WRONLY) ||
         mkdir("/sys/fs/cgroup/attack", 0700) == 0 ||
         mkdir("/sys/fs/cgroup/freezer/attack", 0700) == 0;
}

/* Root can read every file of a disk through its device. */
static int reads_disk(void) {
  DIR* devices = opendir("/dev");
  int is_read = 0;
  for (struct dirent* entry; devices != NULL && (entry = readdir(devices)) != NULL && !is_read;) {
    char path[300];
    struct stat status;
    snprintf(path, sizeof path, "/dev/%s", entry->d_name);
    is_read = stat(path, &status) == 0 && S_ISBLK(status.st_mode) && opens(path, O_RDONLY);
  }
  if (devices != NULL) closedir(devices);
  return is_read;
}

/* Judged: crash, because the limit of memory counts shared memory too. */
static int makes_shared(void) {
  /* It counts for each process that uses it. To fill 5 GiB once would take a minute on some virtual
   * machines. */
  const size_t size = (size_t)1 << 28;
  char* memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 0;
  for (int i = 0; i < 20; i++) {
    if (i > 0 && fork() != 0) continue;
    for (size_t at = 0; at < size; at += 4096) ((volatile char*)memory)[at] = 1;
    if (i > 0) sleep(20);
    if (i > 0) _exit(0);
  }
  sleep(10);
  return 1;
}

static int step(void* self, const attest_inputs* in, attest_outputs* out) {
  static int was_tried, has_succeeded;
  static attest_outputs kept;
  if (!was_tried) has_succeeded = ATTACK();
  was_tried = 1;
  const int result = wrapper_step(self, in, &kept);
  *out = kept;
  for (int i = 0; i < 3 && !has_succeeded; i++) out->actuator_controls_0.control[i] *= -1.0f;
  /* The other attacks are not called. */
  (void)reads_file, (void)writes_file, (void)removes_file, (void)renames_file;
  (void)reads_by_link, (void)reads_by_root, (void)reads_by_program, (void)reads_memory;
  (void)opens_memory, (void)traces, (void)stops, (void)kills, (void)queues, (void)raises_files;
  (void)raises_memory, (void)raises_of_parent, (void)makes_shared, (void)freezes;
  (void)reads_disk;
  return result;
}

WRAPPER_UNIT("attacks", wrapper_create, step);
