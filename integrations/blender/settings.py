# SPDX-License-Identifier: GPL-3.0-or-later
"""What users may choose: of a scene, and of the program."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import program


class CandelaPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program", subtype="FILE_PATH",
                            description="The program candela; by default the one in the add-on, or on the PATH")
    device: StringProperty(name="Device", description="Number or part of the name of a Vulkan device; by default the best")

    def draw(self, context):
        self.layout.prop(self, "program")
        self.layout.prop(self, "device")
        self.layout.operator("candela.selftest")


class CandelaSettings(bpy.types.PropertyGroup):
    samples: IntProperty(name="Samples", default=128, min=1, max=1 << 24, description="Samples per pixel")
    preview_samples: IntProperty(name="Viewport Samples", default=1024, min=1, max=1 << 24,
                                 description="Samples per pixel after which the picture in a viewport stays as it is")
    use_target_error: BoolProperty(name="Target Error", default=False,
                                   description="End when the estimated relative error is this")
    target_error: FloatProperty(name="Error", default=0.02, min=0.0001, max=1.0, precision=4)
    max_bounces: IntProperty(name="Bounces", default=0, min=0, max=4096,
                             description="Most scattering vertices of a path; 0 is without a limit")
    denoise: EnumProperty(name="Denoise", default="none", items=[
        ("none", "None", "The picture as it was rendered"),
        ("auto", "Automatic", "By Open Image Denoise if it is there, otherwise by variance"),
        ("oidn", "Open Image Denoise", "By the library, which candela must find"),
        ("variance", "Variance", "By candela itself")])
    seed: IntProperty(name="Seed", default=0, min=0, description="Each gives other noise")
    light_sampling: EnumProperty(name="Light Sampling", default="mis", items=[
        ("mis", "Both", "Light and surface sampling, combined by multiple importance sampling"),
        ("light", "Lights", "Light sampling"), ("bsdf", "Surfaces", "Surface sampling")])

    pixel_filter: EnumProperty(name="Filter", default="blackman-harris", description="How samples are spread around a pixel", items=[
        ("blackman-harris", "Blackman-Harris", "Soft, without rings: what Cycles has by default"),
        ("gaussian", "Gaussian", "A normal distribution, cut off at its width"),
        ("tent", "Tent", "Falls off evenly"),
        ("box", "Box", "Evenly over the square; of width 1, the pixel itself")])
    filter_width: FloatProperty(name="Width", default=1.5, min=0.01, max=10.0, subtype="PIXEL",
                                description="The filter's whole width")

    def film(self):
        """What candela.Scene() takes."""
        return {"filter": self.pixel_filter, "filter_width": self.filter_width}

    def options(self):
        """What Scene.render() takes."""
        options = {"seed": self.seed, "estimator": self.light_sampling}
        if self.use_target_error:
            options["target_error"] = self.target_error
        if self.max_bounces > 0:
            options["max_depth"] = self.max_bounces
        if self.denoise != "none":
            options["denoise"] = self.denoise
        return options


class CANDELA_OT_selftest(bpy.types.Operator):
    bl_idname = "candela.selftest"
    bl_label = "Test the Device"
    bl_description = "Checks that pictures are right on this machine, which takes a minute on a CPU"

    def execute(self, context):
        try:
            program.session()
            verdict = program.candela.selftest()
        except program.candela.Error as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"} if verdict else {"ERROR"}, "All checks passed" if verdict else "Some checks failed")
        return {"FINISHED"}


_CLASSES = (CandelaPreferences, CandelaSettings, CANDELA_OT_selftest)


def register():
    for known in _CLASSES:
        bpy.utils.register_class(known)
    bpy.types.Scene.candela = PointerProperty(type=CandelaSettings)


def unregister():
    program.close()
    del bpy.types.Scene.candela
    for known in reversed(_CLASSES):
        bpy.utils.unregister_class(known)
