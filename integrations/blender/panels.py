# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels: candela's own, and those of Blender that apply to it."""
import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

_ENGINE = "CANDELA"
# Blender's panels of other engines that mean nothing here.
_HIDDEN = {"RENDER_PT_eevee", "RENDER_PT_gpencil", "RENDER_PT_simplify", "VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes"}


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {_ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine == _ENGINE


class CANDELA_MT_sampling_presets(bpy.types.Menu):
    bl_label = "Sampling Presets"
    preset_subdir = "candela/sampling"
    preset_operator = "script.execute_preset"
    COMPAT_ENGINES = {_ENGINE}
    draw = bpy.types.Menu.draw_preset


class CANDELA_OT_sampling_preset_add(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the settings of candela"""
    bl_idname = "candela.sampling_preset_add"
    bl_label = "Add Sampling Preset"
    preset_menu = "CANDELA_MT_sampling_presets"
    preset_defines = ["settings = bpy.context.scene.candela"]
    preset_values = [f"settings.{name}" for name in (
        "samples", "preview_samples", "use_target_error", "target_error", "max_bounces", "denoise", "light_sampling",
        "pixel_filter", "filter_width")]
    preset_subdir = "candela/sampling"


class CANDELA_PT_sampling_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Sampling Presets"
    preset_subdir = "candela/sampling"
    preset_operator = "script.execute_preset"
    preset_add_operator = "candela.sampling_preset_add"
    COMPAT_ENGINES = {_ENGINE}


class CANDELA_RENDER_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context):
        CANDELA_PT_sampling_presets.draw_panel_header(self.layout)

    def draw(self, context):
        settings, layout = context.scene.candela, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(settings, "samples")
        layout.prop(settings, "preview_samples")
        row = layout.row(heading="Target Error")
        row.prop(settings, "use_target_error", text="")
        sub = row.row()
        sub.active = settings.use_target_error
        sub.prop(settings, "target_error", text="")
        layout.prop(settings, "denoise")
        layout.prop(settings, "light_sampling")
        layout.prop(settings, "seed")


class CANDELA_RENDER_PT_paths(_Panel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.prop(context.scene.candela, "max_bounces")


class CANDELA_RENDER_PT_film(_Panel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.prop(context.scene.render, "film_transparent", text="Transparent")
        self.layout.prop(context.scene.candela, "pixel_filter")
        self.layout.prop(context.scene.candela, "filter_width")


class CANDELA_VIEWLAYER_PT_passes(_Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in ("use_pass_z", "use_pass_normal", "use_pass_position", "use_pass_diffuse_color",
                     "use_pass_cryptomatte_object", "use_pass_cryptomatte_material"):
            self.layout.prop(context.view_layer, name)


_CLASSES = (CANDELA_MT_sampling_presets, CANDELA_OT_sampling_preset_add, CANDELA_PT_sampling_presets, CANDELA_RENDER_PT_sampling,
            CANDELA_RENDER_PT_paths, CANDELA_RENDER_PT_film, CANDELA_VIEWLAYER_PT_passes)


def _blenders():
    """Blender's own panels that every engine with its lights, materials and cameras shows."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if "BLENDER_RENDER" in engines and panel.__name__ not in _HIDDEN and panel not in _CLASSES:
            yield panel


def register():
    for panel in _CLASSES:
        bpy.utils.register_class(panel)
    for panel in _blenders():
        panel.COMPAT_ENGINES.add(_ENGINE)


def unregister():
    for panel in _blenders():
        panel.COMPAT_ENGINES.discard(_ENGINE)
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
