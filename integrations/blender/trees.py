# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees."""
import bpy


def tree_of(owner):
    """The node tree of a material, world or light; None if it has none or does not use it."""
    # From 5.0 on, what has a tree uses it.
    if bpy.app.version < (5, 0, 0) and not owner.use_nodes:
        return None
    return owner.node_tree


def shader_of(tree, name="Surface"):
    """The node that feeds an input of a tree's output; None without one."""
    output = tree.get_output_node("CYCLES") or tree.get_output_node("ALL")
    links = output.inputs[name].links if output is not None else ()
    return links[0].from_node if links else None
