# Built once with everything that takes, run with nothing but what it needs.
FROM python:3.12-slim AS build
WORKDIR /source
ENV PATH=/opt/build/bin:$PATH UV_PYTHON_DOWNLOADS=never UV_NO_CACHE=1
COPY tools/uv.txt tools/uv.txt
RUN python -m venv /opt/build && pip install --no-cache-dir --require-hashes -r tools/uv.txt
COPY . .
# Versions are those of uv.lock: of what builds the wheel, and of what it runs on.
RUN UV_PROJECT_ENVIRONMENT=/opt/build uv sync --locked --inexact --no-install-project --extra client \
  && uv build --wheel --no-build-isolation --python /opt/build/bin/python --out-dir /opt/wheel
RUN UV_PROJECT_ENVIRONMENT=/opt/esplanade uv sync --locked --no-install-project --extra postgresql --extra cluster --extra record \
  && uv pip install --python /opt/esplanade/bin/python --no-deps /opt/wheel/*.whl

FROM python:3.12-slim
RUN useradd --create-home --uid 10001 esplanade
COPY --from=build /opt/esplanade /opt/esplanade
ENV PATH=/opt/esplanade/bin:$PATH PYTHONUNBUFFERED=1
USER esplanade
# Compiled kernels are kept here: on a volume, the second start takes seconds. So is the world as it was, with its operators and the audit.
RUN mkdir -p /home/esplanade/.cache && mkdir -m 700 /home/esplanade/data
VOLUME /home/esplanade/.cache /home/esplanade/data
ENV ESPLANADE_DATA=/home/esplanade/data
EXPOSE 8080
# Health is asked on the private port, from within; the first start compiles for about a minute.
HEALTHCHECK --start-period=180s --interval=10s --timeout=3s --retries=3 \
  CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8081/readyz', timeout=2)"]
STOPSIGNAL SIGTERM
ENTRYPOINT ["esplanade"]
CMD ["serve"]
