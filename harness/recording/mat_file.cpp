#include "harness/recording/mat_file.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <matio.h>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/core/file.hpp"

namespace attest {
namespace {

struct Close {
  void operator()(mat_t* mat) const { Mat_Close(mat); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, Close>;
using Variable = std::unique_ptr<matvar_t, Close>;

// libmatio prints what it finds; attest reports it as an error.
void be_quiet() {
  Mat_LogInitFunc("attest", [](int, char*) {});
}

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
Variable variable_of(const Column& column, matio_classes kind, matio_types type) {
  std::vector<Value> values;
  values.reserve(column.values.size());
  for (const double value : column.values) values.push_back(static_cast<Value>(value));
  std::size_t shape[] = {values.size(), 1};
  return Variable(
      Mat_VarCreate(identifier_of(column.name).c_str(), kind, type, 2, shape, values.data(), 0));
}

// Times as doubles, because MATLAB computes with them. They are exact up to 2^53 us.
Variable variable_of(const Column& column) {
  switch (column.type) {
    case ChannelType::u64:
      return variable_of<double>(column, MAT_C_DOUBLE, MAT_T_DOUBLE);
    case ChannelType::f32:
      return variable_of<float>(column, MAT_C_SINGLE, MAT_T_SINGLE);
    case ChannelType::u8:
    case ChannelType::bit:
      return variable_of<std::uint8_t>(column, MAT_C_UINT8, MAT_T_UINT8);
  }
  return nullptr;
}

bool write_all(const std::string& path, const Table& table) {
  // The header is fixed: libmatio would write the time of day.
  const MatFile mat(
      Mat_CreateVer(path.c_str(), "MATLAB 5.0 MAT-file, written by attest", MAT_FT_MAT5));
  if (!mat) return false;
  for (const Column& column : table) {
    const Variable variable = variable_of(column);
    if (!variable || Mat_VarWrite(mat.get(), variable.get(), MAT_COMPRESSION_NONE) != 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

Result<Table> read_mat(const std::filesystem::path& path) {
  const auto opened = open_regular_file(path);  // for its errors
  if (!opened) return tl::unexpected(opened.error());
  ::close(*opened);
  be_quiet();
  const MatFile mat(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (!mat) return fail_at(path.string(), "is no MAT file, or is cut off");
  Table table;
  while (const Variable variable{Mat_VarReadNext(mat.get())}) {
    auto values = numbers_in(*variable);
    if (values && variable->name != nullptr) table.push_back({variable->name, *std::move(values)});
  }
  return table;
}

Result<void> write_mat(const std::filesystem::path& path, const Table& table) {
  be_quiet();
  // libmatio writes to a path only: to that of a file in memory, so that nothing is left behind.
  const int memory = ::memfd_create("attest.mat", MFD_CLOEXEC);
  if (memory < 0) return fail_at(path.string(), "no memory to write the file in");
  const std::string in_memory = fmt::format("/proc/self/fd/{}", memory);
  const bool is_written = write_all(in_memory, table);
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(::lseek(memory, 0, SEEK_END), 0)), 0);
  const auto count = ::pread(memory, bytes.data(), bytes.size(), 0);
  ::close(memory);
  if (!is_written || count != static_cast<ssize_t>(bytes.size())) {
    return fail_at(path.string(), "libmatio cannot write the table");
  }
  return write_file(path, bytes);
}

}  // namespace attest
