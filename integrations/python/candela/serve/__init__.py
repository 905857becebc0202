"""Pictures over HTTP: `python -m candela.serve --port 8080`; docs/http.md describes the requests."""
from candela.serve._server import Limits, Server

__all__ = ["Limits", "Server"]
