"""Text of several lines, which Blender's layouts do not break."""

import textwrap

_LETTER = 7  # pixels that a letter of the interface takes, on the average, at a scale of 1
_ICON = 4  # letters: what an icon takes
_NARROW = 20  # letters: fewer to a line are not worth breaking for


def letters_of(context):
    """How many letters a line of the region has within its margins."""
    if context.region is None:  # no window
        return 2 * _NARROW
    return max(int(context.region.width / (_LETTER * context.preferences.system.ui_scale)) - 2, _NARROW)


def draw(layout, context, text, icon="NONE", beside=0):
    """The text, broken to the region's width less the letters that what is `beside` it takes; the icon stands before its
    first line."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    letters = letters_of(context) - beside - (0 if icon == "NONE" else _ICON)
    for line in textwrap.wrap(text, letters) or [""]:
        column.label(text=line, icon=icon)
        icon = "BLANK1" if icon != "NONE" else icon
