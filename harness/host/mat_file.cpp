#include "harness/host/mat_file.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <matio.h>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/core/dynamic_library.hpp"
#include "harness/core/file.hpp"
#include "harness/host/mat_layout.hpp"

namespace attest {
namespace {

// The functions of matio.h that are in use. libmatio is loaded when the first MAT file is read or
// written. Linked in, it would bring 33 more libraries (HDF5, curl, Kerberos) into each process,
// and every fork would copy their pages.
struct Matio {
  DynamicLibrary library;
  decltype(&::Mat_LogInitFunc) log_init_func = nullptr;
  decltype(&::Mat_CreateVer) create_ver = nullptr;
  decltype(&::Mat_Open) open = nullptr;
  decltype(&::Mat_Close) close = nullptr;
  decltype(&::Mat_VarCreate) var_create = nullptr;
  decltype(&::Mat_VarFree) var_free = nullptr;
  decltype(&::Mat_VarReadNext) var_read_next = nullptr;
  decltype(&::Mat_VarWrite) var_write = nullptr;
};

Result<Matio> load_matio() {
  auto library = DynamicLibrary::open(ATTEST_MATIO_SONAME);
  if (!library) {
    return fail("MAT files need libmatio: " + library.error().message);
  }
  Matio matio{*library};
  const bool has_all =
      library->find("Mat_LogInitFunc", matio.log_init_func) &&
      library->find("Mat_CreateVer", matio.create_ver) && library->find("Mat_Open", matio.open) &&
      library->find("Mat_Close", matio.close) && library->find("Mat_VarCreate", matio.var_create) &&
      library->find("Mat_VarFree", matio.var_free) &&
      library->find("Mat_VarReadNext", matio.var_read_next) &&
      library->find("Mat_VarWrite", matio.var_write);
  if (!has_all) return fail(ATTEST_MATIO_SONAME " has not all functions of matio.h");
  // This keeps libmatio from printing the errors that it finds, because attest reports them. The
  // message is a const char* only in newer versions of matio.h.
  matio.log_init_func("attest", [](int, auto*) {});
  return matio;
}

// Loads libmatio at the first call. It stays loaded until the process ends.
const Result<Matio>& loaded_matio() {
  static const Result<Matio> matio = load_matio();
  return matio;
}

struct Close {
  const Matio* matio;
  void operator()(mat_t* mat) const { matio->close(mat); }
  void operator()(matvar_t* variable) const { matio->var_free(variable); }
};
using MatFile = std::unique_ptr<mat_t, Close>;
using Variable = std::unique_ptr<matvar_t, Close>;

template <typename Value>
void append(const matvar_t& variable, std::vector<double>& values) {
  const auto* const data = static_cast<const Value*>(variable.data);
  values.assign(data, data + variable.nbytes / sizeof(Value));
}

// The values of a vector of real numbers; empty for other variables.
std::optional<std::vector<double>> numbers_in(const matvar_t& variable) {
  const bool is_vector = variable.rank == 2 && (variable.dims[0] == 1 || variable.dims[1] == 1);
  if (!is_vector || variable.isComplex != 0 || variable.data == nullptr) return std::nullopt;
  std::vector<double> values;
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      append<double>(variable, values);
      return values;
    case MAT_T_SINGLE:
      append<float>(variable, values);
      return values;
    case MAT_T_INT8:
      append<std::int8_t>(variable, values);
      return values;
    case MAT_T_UINT8:
      append<std::uint8_t>(variable, values);
      return values;
    case MAT_T_INT16:
      append<std::int16_t>(variable, values);
      return values;
    case MAT_T_UINT16:
      append<std::uint16_t>(variable, values);
      return values;
    case MAT_T_INT32:
      append<std::int32_t>(variable, values);
      return values;
    case MAT_T_UINT32:
      append<std::uint32_t>(variable, values);
      return values;
    case MAT_T_INT64:
      append<std::int64_t>(variable, values);
      return values;
    case MAT_T_UINT64:
      append<std::uint64_t>(variable, values);
      return values;
    default:
      return std::nullopt;
  }
}

template <typename Value>
Variable variable_of(const Column& column, matio_classes kind, matio_types type,
                     const Matio& matio) {
  std::vector<Value> values;
  values.reserve(column.values.size());
  for (const double value : column.values) values.push_back(static_cast<Value>(value));
  std::size_t shape[] = {values.size(), 1};
  return Variable(
      matio.var_create(identifier_of(column.name).c_str(), kind, type, 2, shape, values.data(), 0),
      Close{&matio});
}

// Times as doubles, because MATLAB computes with them. They are exact up to 2^53 us.
Variable variable_of(const Column& column, const Matio& matio) {
  switch (column.type) {
    case ChannelType::u64:
      return variable_of<double>(column, MAT_C_DOUBLE, MAT_T_DOUBLE, matio);
    case ChannelType::f32:
      return variable_of<float>(column, MAT_C_SINGLE, MAT_T_SINGLE, matio);
    case ChannelType::u8:
    case ChannelType::bit:
      return variable_of<std::uint8_t>(column, MAT_C_UINT8, MAT_T_UINT8, matio);
  }
  return Variable(nullptr, Close{&matio});
}

bool write_all(const std::string& path, const Table& table, const Matio& matio) {
  // The header is fixed: libmatio would write the time of day.
  const MatFile mat(
      matio.create_ver(path.c_str(), "MATLAB 5.0 MAT-file, written by attest", MAT_FT_MAT5),
      Close{&matio});
  if (!mat) return false;
  for (const Column& column : table) {
    const Variable variable = variable_of(column, matio);
    if (!variable || matio.var_write(mat.get(), variable.get(), MAT_COMPRESSION_NONE) != 0) {
      return false;
    }
  }
  return true;
}

Result<void> check_lengths(const std::filesystem::path& path, const Table& table) {
  if (table.empty()) return fail_at(path.string(), "has no column of numbers");
  for (const Column& column : table) {
    if (column.values.size() == table.front().values.size()) continue;
    return fail_at(path.string(),
                   fmt::format("`{}` has {} values, `{}` has {}; each column needs one for "
                               "each tick",
                               column.name, column.values.size(), table.front().name,
                               table.front().values.size()));
  }
  return {};
}

}  // namespace

Result<Table> read_mat(const std::filesystem::path& path, std::size_t) {
  if (auto checked = check_mat_layout(path); !checked) return tl::unexpected(checked.error());
  const auto& matio = loaded_matio();
  if (!matio) return tl::unexpected(matio.error());
  const Close close{&*matio};
  const MatFile mat(matio->open(path.c_str(), MAT_ACC_RDONLY), close);
  if (!mat) return fail_at(path.string(), "is no MAT file, or is cut off");
  Table table;
  while (const Variable variable{matio->var_read_next(mat.get()), close}) {
    auto values = numbers_in(*variable);
    if (values && variable->name != nullptr) table.push_back({variable->name, *std::move(values)});
  }
  if (auto checked = check_lengths(path, table); !checked) return tl::unexpected(checked.error());
  return table;
}

Result<void> write_mat(AtomicFile file, const Trace& trace) {
  const std::string path = file.path().string();
  const auto& matio = loaded_matio();
  if (!matio) return tl::unexpected(matio.error());
  // libmatio can only write to a path. The path is that of a file in memory, which leaves no file
  // behind.
  const int memory = ::memfd_create("attest.mat", MFD_CLOEXEC);
  if (memory < 0) return fail_at(path, "no memory to write the file in");
  const std::string in_memory = fmt::format("/proc/self/fd/{}", memory);
  const bool is_written = write_all(in_memory, table_of(trace), *matio);
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(::lseek(memory, 0, SEEK_END), 0)), 0);
  const auto count = ::pread(memory, bytes.data(), bytes.size(), 0);
  ::close(memory);
  if (!is_written || count != static_cast<ssize_t>(bytes.size())) {
    return fail_at(path, "libmatio cannot write the table");
  }
  return file.commit(bytes);
}

}  // namespace attest
