// A helper of the reports in XML.
#pragma once

#include <string>

#include <pugixml.hpp>

namespace attest {

inline void set_attribute(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
}

}  // namespace attest
