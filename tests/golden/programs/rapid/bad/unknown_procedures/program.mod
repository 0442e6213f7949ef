MODULE M
  PROC main()
    take;
    tke;
    Take;
  ENDPROC
  PROC takes()
  ENDPROC
ENDMODULE
