MODULE M
  VAR num n;
  PROC main()
    WHILE TRUE DO
      n:=n+1;
    ENDWHILE
  ENDPROC
ENDMODULE
