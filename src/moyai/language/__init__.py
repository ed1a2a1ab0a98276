"""English texts in another language: catalogues, the matching of finished sentences, the language in force."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.language.current import language_of_the_locale as language_of_the_locale
    from moyai.language.current import require_language as require_language
    from moyai.language.current import said as said
    from moyai.language.current import speak as speak
    from moyai.language.current import spoken_in as spoken_in
    from moyai.language.current import spoken_language as spoken_language
else:
    __getattr__, __dir__, __all__ = exports(
        __name__, {"current": "language_of_the_locale require_language said speak spoken_in spoken_language"}
    )
