"""Maths as MathML, which browsers show by themselves: no script, nothing to fetch."""

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.util import logging

logger = logging.getLogger(__name__)


def mathml(node, block):
    """MathML of a maths node; what cannot be read is a warning, and stays as it was written."""
    source = node.astext().strip()
    try:
        return latex2mathml.tex2mathml(source, as_block=block)
    except MathError as error:
        logger.warning("maths cannot be shown: %s", error, location=node)
        return f"<code>{source.replace('&', '&amp;').replace('<', '&lt;')}</code>"


def visit_inline(self, node):
    self.body.append(mathml(node, block=False))
    raise nodes.SkipNode


def visit_block(self, node):
    self.body.append(
        self.starttag(node, "div", CLASS="math notranslate nohighlight")
        + mathml(node, block=True)
        + "</div>\n"
    )
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
