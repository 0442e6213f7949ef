MODULE M
  PROC main()
    Set do1;
  ENDPROC
  PROC Main()
    Set do2;
  ENDPROC
ENDMODULE
