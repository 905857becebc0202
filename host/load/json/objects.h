// Objects of a scene file: named groups of shapes that are only seen where a shape of type "instance" places
// them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "load/json/shape_list.h"
#include "load/node.h"

namespace candela {

using ObjectMap = std::map<std::string, std::vector<Shape>, std::less<>>;

// Reads an instance and adds a copy of each shape of its object, placed by its transforms. Its material and
// emission, if any, replace the shapes' own.
void read_instance(const Node& node, const ObjectMap& objects, ShapeList& shapes);

}  // namespace candela
